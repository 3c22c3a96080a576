//! Tests of whole figures.
use super::*;
