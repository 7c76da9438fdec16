//! The columns of the table: for each a name, and what it holds of a row.

use super::row::Row;

/// How to read a cell.
pub enum Cell {
    /// Text; empty where there is none.
    Text(fn(&Row) -> &str),
    /// A number, SI units.
    Number(fn(&Row) -> Option<f64>),
}

/// A column.
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// What it holds.
    pub cell: Cell,
}

/// A column that is named as the field of a row.
macro_rules! column {
    (text $field:ident) => {
        Column { name: stringify!($field), cell: Cell::Text(|row| &row.$field) }
    };
    (number $field:ident) => {
        Column { name: stringify!($field), cell: Cell::Number(|row| row.$field) }
    };
}

/// All columns, in their order: those of the rig, then those of the value.
pub const COLUMNS: [Column; 25] = [
    column!(text rig),
    column!(text verdict),
    column!(text effects),
    column!(text alternatives),
    column!(text error),
    column!(text channel),
    column!(text residual_unit),
    column!(number expected_noise),
    column!(number residual_as_given),
    column!(number residual_refitted),
    column!(number residual_improved),
    column!(number explained_share),
    column!(number residual_over_noise),
    column!(number grave_findings),
    column!(text inputs_sha256),
    column!(text effect),
    column!(text acts_in),
    column!(number held_out_gain),
    column!(number p_value),
    column!(text parameter),
    column!(text unit),
    column!(number given),
    column!(number value),
    column!(number ci95_low),
    column!(number ci95_high),
];
