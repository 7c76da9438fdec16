//! `palpate investigate` as a user runs it, and its parts on rigs alone.

mod investigate {
    mod command_line;
    mod design;
    mod emulated_drive;
    mod simulated_bed;
    #[cfg(unix)]
    mod sources;
}
