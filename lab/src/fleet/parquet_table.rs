//! The table as Parquet.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::Result;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

use super::column::{COLUMNS, Cell};
use super::row::Row;

/// Writes `rows` in one row group with Snappy; what is empty is null.
///
/// # Errors
/// Whatever `out` reports.
pub fn write(rows: &[Row], out: impl Write + Send) -> Result<()> {
    let fields = COLUMNS.iter().map(|column| match column.cell {
        Cell::Text(_) => format!("optional binary {} (utf8);", column.name),
        Cell::Number(_) => format!("optional double {};", column.name),
    });
    let schema = format!("message rig_values {{ {} }}", fields.collect::<String>());
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer = SerializedFileWriter::new(out, Arc::new(parse_message_type(&schema)?), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in &COLUMNS {
        write_column(&column.cell, rows, &mut group)?;
    }
    group.close()?;
    writer.close()?;
    Ok(())
}

fn write_column<W: Write + Send>(cell: &Cell, rows: &[Row], group: &mut SerializedRowGroupWriter<'_, W>) -> Result<()> {
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    // A definition level says of each row whether it has a value; the values alone follow.
    match cell {
        Cell::Text(read) => {
            let cells: Vec<&str> = rows.iter().map(read).collect();
            let levels: Vec<i16> = cells.iter().map(|cell| i16::from(!cell.is_empty())).collect();
            let there =
                cells.iter().filter(|cell| !cell.is_empty()).map(|cell| ByteArray::from(*cell)).collect::<Vec<_>>();
            column.typed::<ByteArrayType>().write_batch(&there, Some(&levels), None)?;
        }
        Cell::Number(read) => {
            let cells: Vec<Option<f64>> = rows.iter().map(read).collect();
            let levels: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
            let there: Vec<f64> = cells.into_iter().flatten().collect();
            column.typed::<DoubleType>().write_batch(&there, Some(&levels), None)?;
        }
    }
    column.close()
}
