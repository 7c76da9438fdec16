//! The table of a fleet: a row for each value of each rig, as CSV and Parquet.

use std::io::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result};

use super::column::{COLUMNS, Cell};
use super::parquet_table;
use super::row::{NOMINAL, Row};
use super::worker::RigResult;
use crate::error::InputError;
use crate::outfile::OutFile;

/// The table in text; read again by `--against`.
pub const CSV: &str = "table.csv";
/// The table in columns.
pub const PARQUET: &str = "table.parquet";

/// All rows, those of a rig together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    rows: Vec<Row>,
}

/// One rig of a table.
#[derive(Debug, Clone, Copy)]
pub struct Rig<'a> {
    rows: &'a [Row],
}

impl Table {
    /// Of `results`, in their order.
    #[must_use]
    pub fn of(results: &[RigResult]) -> Self {
        Self { rows: results.iter().flat_map(Row::all_of).collect() }
    }

    /// Its rigs, in their order.
    pub fn rigs(&self) -> impl Iterator<Item = Rig<'_>> {
        self.rows.chunk_by(|one, other| one.rig == other.rig).map(|rows| Rig { rows })
    }

    /// Writes it into `folder`, as CSV and as Parquet.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let mut file = OutFile::create(&folder.join(CSV))?;
        let text = self.to_csv().context("the table cannot be written as CSV")?;
        file.write_all(&text).map_err(|error| file.fault(&error))?;
        file.commit()?;
        let mut file = OutFile::create(&folder.join(PARQUET))?;
        let mut bytes = Vec::new();
        parquet_table::write(&self.rows, &mut bytes).context("the table cannot be written as Parquet")?;
        file.write_all(&bytes).map_err(|error| file.fault(&error))?;
        Ok(file.commit()?)
    }

    /// Numbers in the fewest digits that give them back to the bit.
    fn to_csv(&self) -> Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(COLUMNS.map(|column| column.name))?;
        for row in &self.rows {
            writer.write_record(COLUMNS.map(|column| match column.cell {
                Cell::Text(read) => read(row).to_owned(),
                Cell::Number(read) => read(row).map(|number| format!("{number:?}")).unwrap_or_default(),
            }))?;
        }
        Ok(writer.into_inner()?)
    }

    /// The table that an earlier run left in `folder`.
    ///
    /// # Errors
    /// There is none, or it is none of this program.
    pub fn read(folder: &Path) -> Result<Self, InputError> {
        let path = folder.join(CSV);
        let expected = "the table of an earlier `palpate diagnose-all`";
        let text = std::fs::read(&path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => InputError::new(path.display(), "no such file", expected),
            _ => InputError::new(path.display(), format!("it cannot be read: {error}"), expected),
        })?;
        let mut reader = csv::Reader::from_reader(text.as_slice());
        let header = reader.headers().map_err(|error| InputError::new(path.display(), error, expected))?.clone();
        // What is read by name would otherwise be taken for empty.
        if let Some(lacking) = COLUMNS.iter().find(|column| !header.iter().any(|name| name == column.name)) {
            return Err(InputError::new(path.display(), format!("no column {}", lacking.name), expected));
        }
        let rows = reader.deserialize().collect::<Result<Vec<Row>, _>>();
        Ok(Self { rows: rows.map_err(|error| InputError::new(path.display(), error, expected))? })
    }
}

impl<'a> Rig<'a> {
    /// What holds for the whole rig, in the columns up to `inputs_sha256`.
    #[must_use]
    pub fn head(&self) -> &'a Row {
        &self.rows[0]
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'a str {
        &self.head().rig
    }

    /// Whether there is no diagnosis of it.
    #[must_use]
    pub fn is_failed(&self) -> bool {
        self.head().verdict.is_empty()
    }

    /// Effects that are named, "unknown" among them.
    #[must_use]
    pub fn effects(&self) -> Vec<&'a str> {
        self.head().effects.split("; ").filter(|name| !name.is_empty()).collect()
    }

    /// Its rows with a value.
    pub fn values(&self) -> impl Iterator<Item = &'a Row> + use<'a> {
        self.rows.iter().filter(|row| row.value.is_some())
    }

    /// Its rows with a value of a named effect.
    pub fn effect_values(&self) -> impl Iterator<Item = &'a Row> + use<'a> {
        self.values().filter(|row| row.effect != NOMINAL)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use serde_json::{Value, json};

    /// The result of a rig named `name`: effects with a value of 2 N and its half-width, and a nominal stiffness.
    pub fn result(name: &str, effects: &[(&str, f64, f64)], stiffness: f64) -> RigResult {
        let values = |value: f64, half: f64| json!([value - half, value + half]);
        let physics: Vec<Value> = effects
            .iter()
            .map(|(name, value, half)| {
                let parameter = json!({"name": "force", "value": value, "unit": "N", "ci95": values(*value, *half)});
                json!({"name": name, "acts_in": "drive", "evidence": {"held_out_gain": 0.5, "p_value": 1e-9}, "parameters": [parameter]})
            })
            .collect();
        let nominal = json!([{"name": "stiffness_n_m", "unit": "N/m", "given": 300.0, "fitted": stiffness, "ci95": values(stiffness, 1.0)}]);
        let all = json!({
            "schema": "palpate.diagnosis/1", "verdict": if effects.is_empty() { "no_mismatch" } else { "explained" },
            "physics": physics, "rivals": [{"physics": ["a", "b"]}, {"physics": ["c"]}], "nominal": nominal,
            "fit": {"channel": "effort", "unit": "N", "noise_floor": 0.1, "as_given": 0.9, "refitted": 0.4, "improved": 0.11, "explained_share": 0.9},
            "findings": [{"code": "x", "grave": true}, {"code": "y", "grave": false}],
        });
        let diagnosis = Ok(serde_json::from_value(all).unwrap());
        RigResult { name: name.to_owned(), inputs_sha256: "5a".to_owned(), diagnosis, is_earlier: false }
    }

    pub fn failed(name: &str, error: &str) -> RigResult {
        RigResult { diagnosis: Err(error.to_owned()), ..result(name, &[], 300.0) }
    }

    fn example() -> Table {
        let mut nothing = result("nothing, \"quoted\"", &[], 299.123_456_789_012_3);
        nothing.diagnosis.as_mut().unwrap().nominal.clear();
        Table::of(&[
            result("a", &[("gravity_load", 2.0, 0.1), ("unknown", 0.1 + 0.2, 1e-9)], 301.0),
            nothing,
            failed("c", "gone"),
        ])
    }

    #[test]
    fn a_rig_has_a_row_for_each_value_or_one_without() {
        let table = example();
        let rows: Vec<_> = table.rows.iter().map(|row| (row.rig.as_str(), row.effect.as_str(), row.value)).collect();
        assert_eq!(
            rows,
            [
                ("a", "gravity_load", Some(2.0)),
                ("a", "unknown", Some(0.1 + 0.2)),
                ("a", "nominal", Some(301.0)),
                ("nothing, \"quoted\"", "", None),
                ("c", "", None),
            ]
        );
        let rigs: Vec<Rig<'_>> = table.rigs().collect();
        assert_eq!(rigs.iter().map(Rig::name).collect::<Vec<_>>(), ["a", "nothing, \"quoted\"", "c"]);
        assert_eq!(rigs[0].effects(), ["gravity_load", "unknown"]);
        let head = rigs[0].head();
        assert_eq!((head.alternatives.as_str(), head.grave_findings), ("a + b; c", Some(1.0)));
        assert!((head.residual_over_noise.unwrap() - 1.1).abs() < 1e-12);
        assert_eq!(rigs.iter().map(Rig::is_failed).collect::<Vec<_>>(), [false, false, true]);
        assert_eq!(rigs[2].head().error, "gone");
    }

    #[test]
    fn what_is_written_is_read_again_to_the_bit() {
        let (home, table) = (tempfile::tempdir().unwrap(), example());
        table.write(home.path()).unwrap();
        assert_eq!(Table::read(home.path()).unwrap(), table);
    }

    #[test]
    fn parquet_holds_the_cells_of_the_rows() {
        use parquet::file::reader::{FileReader as _, SerializedFileReader};
        use parquet::record::Field;
        let (home, table) = (tempfile::tempdir().unwrap(), example());
        table.write(home.path()).unwrap();
        let file = std::fs::File::open(home.path().join(PARQUET)).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        let found: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(found.len(), table.rows.len());
        for (found, row) in found.iter().zip(&table.rows) {
            for ((name, field), column) in found.get_column_iter().zip(&COLUMNS) {
                let expected = match column.cell {
                    Cell::Text(read) if read(row).is_empty() => Field::Null,
                    Cell::Text(read) => Field::Str(read(row).to_owned()),
                    Cell::Number(read) => read(row).map_or(Field::Null, Field::Double),
                };
                assert_eq!((name.as_str(), field), (column.name, &expected));
            }
        }
    }

    #[test]
    fn a_file_that_is_no_such_table_is_refused() {
        let home = tempfile::tempdir().unwrap();
        assert!(Table::read(home.path()).unwrap_err().to_string().contains("no such file"));
        std::fs::write(home.path().join(CSV), "rig,verdict\na,b\n").unwrap();
        assert!(Table::read(home.path()).unwrap_err().to_string().contains("no column effects"));
    }
}
