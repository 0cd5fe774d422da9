#![no_main]
libfuzzer_sys::fuzz_target!(|data: &[u8]| tissuebench_fuzz_engine::run("import", data));
