//! Memory of this process, as the system counts it.

/// Resident memory now, in MiB; `None` where the system does not say.
#[must_use]
pub fn resident() -> Option<f64> {
    field("VmRSS:")
}

/// The most resident memory so far, in MiB; `None` where the system does not say.
#[must_use]
pub fn peak() -> Option<f64> {
    field("VmHWM:")
}

fn field(name: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes / 1024.0)
}
