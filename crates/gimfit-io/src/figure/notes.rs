//! Remarks at the foot of a figure on what it leaves out.

use super::plot::Axis;
use super::text;

/// Remarks in the order in which they arose, each once.
#[derive(Default)]
pub(crate) struct Notes {
    remarks: Vec<String>,
}

impl Notes {
    pub(crate) fn add(&mut self, remark: String) {
        if !self.remarks.contains(&remark) {
            self.remarks.push(remark);
        }
    }

    /// Says that only every `stride`-th of what `name` names is drawn.
    pub(crate) fn stride(&mut self, name: &str, stride: usize) {
        if stride > 1 {
            self.add(format!("every {} {name} drawn", text::ordinal(stride)));
        }
    }

    /// Explains offsets, if one of `axes` has one.
    pub(crate) fn offset(&mut self, axes: &[&Axis]) {
        if axes.iter().any(|axis| axis.has_offset) {
            self.offset_of_labels();
        }
    }

    /// Explains what stands in brackets behind the name of an axis.
    pub(crate) fn offset_of_labels(&mut self) {
        self.add("in brackets behind the name of an axis: what its labels are multiplied by, and what is added then".to_owned());
    }

    /// All remarks as one sentence; empty without any.
    pub(crate) fn sentence(&self) -> String {
        let mut sentence = self.remarks.join("; ");
        if let Some(first) = sentence.chars().next() {
            let upper: String = first.to_uppercase().collect();
            sentence.replace_range(..first.len_utf8(), &upper);
            sentence.push('.');
        }
        sentence
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_are_said_once() {
        let mut notes = Notes::default();
        notes.stride("data point", 1);
        assert_eq!(notes.sentence(), "");
        notes.stride("data point", 25);
        notes.stride("data point", 25);
        notes.add("more".to_owned());
        assert_eq!(notes.sentence(), "Every 25th data point drawn; more.");
    }
}
