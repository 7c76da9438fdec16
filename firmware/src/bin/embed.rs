//! The library in a firmware of one's own: an estimate from one's own timer interrupt, below one's own current loop.
//!
//! Nothing of `palpate::drive` is needed for this, and nothing here is more than is: TIM7 at 1 kHz, one sample, one update, one
//! pair of numbers for whoever asks. `docs/drive.md` explains it line by line.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod own {
    use core::cell::UnsafeCell;
    use core::mem::MaybeUninit;
    use core::sync::atomic::{AtomicU32, Ordering};

    use cortex_m_rt::entry;
    use palpate::{BlockConfig, BlockLeastSquares, Flags, Identifier, Sample, StreamConfig};
    use stm32f4xx_hal::pac::{self, Interrupt, NVIC, interrupt};
    use stm32f4xx_hal::prelude::*;
    use stm32f4xx_hal::rcc::Config;
    use stm32f4xx_hal::timer::{CounterHz, Event};

    /// Block least squares on 300 samples: 4 kB.
    type Estimator = Identifier<BlockLeastSquares, 300>;

    /// What the interrupt owns, written once before it is let in.
    struct Owned(UnsafeCell<MaybeUninit<(Estimator, CounterHz<pac::TIM7>)>>);

    // SAFETY: `main` writes it before it unmasks the interrupt, and from then on the interrupt alone uses it.
    unsafe impl Sync for Owned {}

    static OWNED: Owned = Owned(UnsafeCell::new(MaybeUninit::uninit()));

    /// The latest K and B, as bits; NaN where they are not to be used.
    static STIFFNESS: AtomicU32 = AtomicU32::new(f32::NAN.to_bits());
    static DAMPING: AtomicU32 = AtomicU32::new(f32::NAN.to_bits());

    #[entry]
    fn main() -> ! {
        let run = || {
            let law = BlockLeastSquares::new(BlockConfig::default()).ok()?;
            let estimator = Identifier::new(StreamConfig::BENCH, law).ok()?;
            let (chip, mut core) = (pac::Peripherals::take()?, cortex_m::Peripherals::take()?);
            let mut rcc = chip.RCC.freeze(Config::hsi().sysclk(168.MHz()));
            let mut timer = chip.TIM7.counter_hz(&mut rcc);
            timer.start(1.kHz()).ok()?;
            timer.listen(Event::Update);
            // SAFETY: the interrupt is masked still.
            unsafe { (*OWNED.0.get()).write((estimator, timer)) };
            // SAFETY: no critical section relies on a priority. 0xC0 is below a current loop at 0x00 to 0xB0.
            unsafe {
                core.NVIC.set_priority(Interrupt::TIM7, 0xc0);
                NVIC::unmask(Interrupt::TIM7);
            }
            Some(())
        };
        // Settings that are refused are seen at the bench, before anything moves.
        if run().is_none() {
            cortex_m::peripheral::SCB::sys_reset();
        }
        loop {
            cortex_m::asm::wfi();
        }
    }

    /// Your sensors: metres into the surface, newtons when the tool pushes.
    fn read_sensors() -> (f32, f32) {
        (0.0, 0.0)
    }

    #[interrupt]
    fn TIM7() {
        // SAFETY: it was written before the interrupt was unmasked, and the interrupt does not preempt itself.
        let (estimator, timer) = unsafe { (*OWNED.0.get()).assume_init_mut() };
        timer.clear_all_flags();
        let (position, force) = read_sensors();
        let (stiffness, damping) = match estimator.update(Sample { position, force, elapsed: 1e-3 }) {
            Ok(e) if !e.flags.intersects(Flags::NO_CONTACT | Flags::HELD | Flags::STIFFNESS_UNCERTAIN) => {
                (e.impedance.stiffness, e.impedance.damping)
            }
            // Nothing is touched or known, or the sample was no number: then there is nothing to go by.
            _ => (f32::NAN, f32::NAN),
        };
        STIFFNESS.store(stiffness.to_bits(), Ordering::Relaxed);
        DAMPING.store(damping.to_bits(), Ordering::Relaxed);
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        cortex_m::peripheral::SCB::sys_reset()
    }
}

/// Nothing to run on a host.
#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is an image for thumbv7em-none-eabihf; see docs/drive.md");
}
