//! The history of a run, within bounded memory.

/// Residual after an iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryEntry {
    /// Steps taken before.
    pub iteration: usize,
    /// Largest norm of a difference vector.
    pub max_residual: f64,
    /// Root mean square of the norms.
    pub rms_residual: f64,
    /// Of least squares: [`ResidualNorms::normal`](crate::collocation::ResidualNorms::normal), the
    /// largest mean difference vector of a control point, which falls to 0 where residuals do not.
    pub normal_residual: Option<f64>,
}

impl HistoryEntry {
    /// What tells how far the iteration is from its limit: the normal residual where there is one,
    /// otherwise the largest residual.
    #[must_use]
    pub fn to_limit(&self) -> f64 {
        self.normal_residual.unwrap_or(self.max_residual)
    }
}

/// Entries a trace holds at most.
pub const MAX_ENTRIES: usize = 10_000;

/// Collects [`HistoryEntry`]s. A run longer than [`MAX_ENTRIES`] keeps every second, fourth, ...
/// entry, the first and the last always.
#[derive(Debug, Clone)]
pub struct Trace {
    entries: Vec<HistoryEntry>,
    stride: usize,
    last: Option<HistoryEntry>,
}

impl Trace {
    /// A trace that allocates once.
    #[must_use]
    pub fn with_room_for(iterations: usize) -> Self {
        let room = iterations.saturating_add(2).min(MAX_ENTRIES);
        Self { entries: Vec::with_capacity(room), stride: 1, last: None }
    }

    /// Notes an entry.
    pub fn push(&mut self, entry: HistoryEntry) {
        self.last = Some(entry);
        if !entry.iteration.is_multiple_of(self.stride) {
            return;
        }
        if self.entries.len() + 1 >= MAX_ENTRIES {
            self.stride *= 2;
            let stride = self.stride;
            self.entries.retain(|kept| kept.iteration.is_multiple_of(stride));
            if !entry.iteration.is_multiple_of(stride) {
                return;
            }
        }
        self.entries.push(entry);
    }

    /// The entries, the last one included.
    #[must_use]
    pub fn into_entries(mut self) -> Vec<HistoryEntry> {
        if self.entries.last() != self.last.as_ref() {
            self.entries.extend(self.last);
        }
        self.entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_run_keeps_its_first_and_last_entry_in_bounded_memory() {
        let mut trace = Trace::with_room_for(usize::MAX);
        for iteration in 0..123_457 {
            trace.push(HistoryEntry {
                iteration,
                max_residual: 1.0,
                rms_residual: 1.0,
                normal_residual: None,
            });
        }
        let entries = trace.into_entries();
        assert!(entries.len() <= MAX_ENTRIES && entries.len() > MAX_ENTRIES / 4);
        assert_eq!((entries[0].iteration, entries[entries.len() - 1].iteration), (0, 123_456));
        assert!(entries.windows(2).all(|pair| pair[0].iteration < pair[1].iteration));
    }
}
