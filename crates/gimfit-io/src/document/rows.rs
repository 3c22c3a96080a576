//! Points as nested arrays in JSON and flat in memory.

use gimfit::Points;
use serde::de::{self, SeqAccess, Visitor};
use serde::ser::SerializeSeq;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// Points written as `[[x, y, ..], ..]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PointRows {
    /// Length of a row; 0 if there are none.
    pub dimension: usize,
    /// The rows one after another.
    pub values: Vec<f64>,
}

impl From<&Points> for PointRows {
    fn from(points: &Points) -> Self {
        Self { dimension: points.dimension(), values: points.coordinates().to_vec() }
    }
}

impl Serialize for PointRows {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rows = self.values.chunks_exact(self.dimension.max(1));
        let mut sequence = serializer.serialize_seq(Some(rows.len()))?;
        for row in rows {
            sequence.serialize_element(row)?;
        }
        sequence.end()
    }
}

impl<'de> Deserialize<'de> for PointRows {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(RowsVisitor)
    }
}

struct RowsVisitor;

impl<'de> Visitor<'de> for RowsVisitor {
    type Value = PointRows;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array of points, each an array of numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut rows: A) -> Result<PointRows, A::Error> {
        let mut points = PointRows::default();
        let mut count = 0;
        while let Some(row) = rows.next_element::<Vec<f64>>()? {
            if count == 0 {
                points.dimension = row.len();
            }
            if row.len() != points.dimension || row.is_empty() {
                return Err(de::Error::custom(format!(
                    "control point {count} has {} coordinates, those before have {}",
                    row.len(),
                    points.dimension
                )));
            }
            points.values.extend_from_slice(&row);
            count += 1;
        }
        Ok(points)
    }
}
