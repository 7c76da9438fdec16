use palpate_lab::reproduce::*;

#[test]
fn print() {
    let t = std::time::Instant::now();
    let trials = study::trials().unwrap();
    println!("sim {:?}", t.elapsed());
    for reading in study::Reading::ALL {
        let s = study::Study::of(reading, &trials, &|| ()).unwrap();
        println!("{} {:?}", reading.name, t.elapsed());
        for (m, row) in paper::METHODS.iter().zip(&s.by_contact) {
            for (c, p) in row.iter().zip(0..3) {
                println!(
                    "  {m} {} rmse {:.2}±{:.2} later {:.2} std {:.2} conv {:.3}±{:.3}",
                    bench::Contact::PAPER[p].name(),
                    c.rmse.mean,
                    c.rmse.deviation,
                    c.rmse_later.mean,
                    c.deviation.mean,
                    c.converged.mean,
                    c.converged.deviation
                );
            }
        }
        for (w, cells) in paper::WINDOWS.iter().zip(&s.by_window) {
            println!(
                "  W {w}: {}",
                cells.iter().map(|c| format!("{:.2} (std {:.2}) ", c.rmse.mean, c.deviation.mean)).collect::<String>()
            );
        }
    }
    let rows = better::study(&better::trials().unwrap(), &|| ()).unwrap();
    println!("better {:?}", t.elapsed());
    let f = |s: &measure::Spread| format!("{:.2}±{:.2}", s.mean, s.deviation);
    for r in &rows {
        println!(
            "{:34} on {} up {} down {} std {} bK {} bB {} rmse {} cK {} cB {} fa {}",
            r.name(),
            f(&r.onset),
            f(&r.up),
            f(&r.down),
            f(&r.deviation),
            f(&r.bias_stiffness),
            f(&r.bias_damping),
            f(&r.rmse),
            f(&r.covered_stiffness),
            f(&r.covered_damping),
            r.false_alarms
        );
    }
    for c in models::study(&|| ()).unwrap() {
        println!(
            "{} plain K {} B {} rmse {} / {}",
            c.name,
            f(&c.plain[0]),
            f(&c.plain[1]),
            f(&c.rmse[0]),
            f(&c.rmse[1])
        );
        for p in &c.parameters {
            println!(
                "   {} true {} found {:.4}±{:.4} half {:.4}",
                p.symbol, p.truth, p.found.mean, p.found.deviation, p.half_width
            );
        }
    }
    for r in force::study(&|| ()).unwrap() {
        println!(
            "{:36} up {} down {} peak {} {} rms {} unstable {}",
            r.source.name(),
            f(&r.settled_up),
            f(&r.settled_down),
            f(&r.peak_up),
            f(&r.peak_down),
            f(&r.rms),
            r.unstable
        );
    }
    println!("all {:?}", t.elapsed());
}
