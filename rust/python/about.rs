//! What a report of a bug should say of the core.

use pyo3::prelude::*;

/// Its version, how it was built, for what processor, and the features of that which are found here.
#[pyfunction]
pub fn about() -> (&'static str, &'static str, &'static str, Vec<&'static str>) {
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    (env!("CARGO_PKG_VERSION"), build, std::env::consts::ARCH, features())
}

/// Those that change speed and last digits: fused and wide arithmetic.
fn features() -> Vec<&'static str> {
    #[cfg(target_arch = "x86_64")]
    let found = [
        ("fma", is_x86_feature_detected!("fma")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(target_arch = "aarch64")]
    let found = [("neon", std::arch::is_aarch64_feature_detected!("neon"))];
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    let found: [(&str, bool); 0] = [];
    found.into_iter().filter(|(_, there)| *there).map(|(name, _)| name).collect()
}
