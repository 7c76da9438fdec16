//! One array in NumPy's format NPY, versions 1 to 3 (numpy.lib.format).

/// An array of numbers, or a single text.
#[derive(Debug, Clone, PartialEq)]
pub enum NpyArray {
    /// Numbers in C order: the last index runs fastest.
    Numbers {
        /// Length along each axis.
        shape: Vec<usize>,
        /// As many as the product of `shape`.
        values: Vec<f64>,
    },
    /// An array of one text.
    Text(String),
}

const MAGIC: &[u8] = b"\x93NUMPY";

/// The array in `bytes`.
///
/// # Errors
/// What was found instead of an array of numbers, in words.
pub fn parse(bytes: &[u8]) -> Result<NpyArray, String> {
    let (header, data) = split(bytes).ok_or("bytes that are no NumPy array")?;
    let kind = value_of(header, "descr").and_then(quoted).ok_or("an array of records")?;
    let shape = value_of(header, "shape").and_then(shape).ok_or("an array whose shape cannot be read")?;
    let fortran = value_of(header, "fortran_order").is_some_and(|value| value.starts_with("True"));
    let count =
        shape.iter().try_fold(1_usize, |count, axis| count.checked_mul(*axis)).ok_or("an array of impossible size")?;
    if kind.contains('O') {
        return Err("an object array, which is a pickled program".to_owned());
    }
    if let Some(length) = kind.strip_prefix(['<', '>']).and_then(|kind| kind.strip_prefix('U')) {
        return text(kind.starts_with('>'), length, count, data);
    }
    let (width, number) = decoder(kind).ok_or_else(|| format!("an array of {kind}"))?;
    let needed = count.checked_mul(width).filter(|needed| *needed <= data.len());
    let data = &data[..needed.ok_or_else(|| format!("{} bytes of {count} values of {kind}", data.len()))?];
    let values: Vec<f64> = data.chunks_exact(width).map(number).collect();
    Ok(NpyArray::Numbers { values: if fortran { in_c_order(&values, &shape) } else { values }, shape })
}

/// The header's text and the data after it.
fn split(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let rest = bytes.strip_prefix(MAGIC)?;
    let (version, rest) = rest.split_first_chunk::<2>()?;
    let (length, rest) = if version[0] == 1 {
        let (length, rest) = rest.split_first_chunk::<2>()?;
        (usize::from(u16::from_le_bytes(*length)), rest)
    } else {
        let (length, rest) = rest.split_first_chunk::<4>()?;
        (usize::try_from(u32::from_le_bytes(*length)).ok()?, rest)
    };
    let (header, data) = rest.split_at_checked(length)?;
    Some((std::str::from_utf8(header).ok()?, data))
}

/// What follows `'key':` in the header, a Python dictionary with literal values.
fn value_of<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let at = header.find(&format!("'{key}'"))? + key.len() + 2;
    Some(header[at..].trim_start().strip_prefix(':')?.trim_start())
}

fn quoted(value: &str) -> Option<&str> {
    let quote = value.chars().next().filter(|quote| matches!(quote, '\'' | '"'))?;
    value[1..].split(quote).next()
}

fn shape(value: &str) -> Option<Vec<usize>> {
    let inside = value.strip_prefix('(')?.split(')').next()?;
    inside.split(',').map(str::trim).filter(|axis| !axis.is_empty()).map(|axis| axis.parse().ok()).collect()
}

/// Bytes of one value, and their meaning.
type Decoder = (usize, fn(&[u8]) -> f64);

/// How one value of NumPy's `kind`, "<f8" say, is read.
fn decoder(kind: &str) -> Option<Decoder> {
    /// The value of `chunk` in the byte order of `$from`; chunks are as long as the type by construction.
    macro_rules! number {
        ($type:ty, $from:ident) => {
            (size_of::<$type>(), |chunk: &[u8]| chunk.try_into().map_or(f64::NAN, |bytes| <$type>::$from(bytes) as f64))
        };
    }
    Some(match kind {
        "<f8" => number!(f64, from_le_bytes),
        ">f8" => number!(f64, from_be_bytes),
        "<f4" => number!(f32, from_le_bytes),
        ">f4" => number!(f32, from_be_bytes),
        "<i8" => number!(i64, from_le_bytes),
        ">i8" => number!(i64, from_be_bytes),
        "<i4" => number!(i32, from_le_bytes),
        ">i4" => number!(i32, from_be_bytes),
        "<i2" => number!(i16, from_le_bytes),
        ">i2" => number!(i16, from_be_bytes),
        "|i1" => number!(i8, from_le_bytes),
        "<u8" => number!(u64, from_le_bytes),
        ">u8" => number!(u64, from_be_bytes),
        "<u4" => number!(u32, from_le_bytes),
        ">u4" => number!(u32, from_be_bytes),
        "<u2" => number!(u16, from_le_bytes),
        ">u2" => number!(u16, from_be_bytes),
        "|u1" | "|b1" => number!(u8, from_le_bytes),
        _ => return None,
    })
}

/// A single text of `length` code points.
fn text(is_big_endian: bool, length: &str, count: usize, data: &[u8]) -> Result<NpyArray, String> {
    let needed =
        length.parse::<usize>().ok().and_then(|length| length.checked_mul(4)).filter(|needed| *needed <= data.len());
    let (1, Some(needed)) = (count, needed) else { return Err("an array of text".to_owned()) };
    let letter = |chunk: &[u8]| {
        let bytes: [u8; 4] = chunk.try_into().ok()?;
        char::from_u32(if is_big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    };
    let letters: Option<String> = data[..needed].chunks_exact(4).map(letter).collect();
    Ok(NpyArray::Text(letters.ok_or("text that is not Unicode")?.trim_end_matches('\0').to_owned()))
}

/// From Fortran's order, where the first index runs fastest.
fn in_c_order(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let source = |at: usize| {
        let (mut rest, mut source) = (at, 0);
        let mut stride = values.len();
        for axis in shape.iter().rev() {
            stride /= axis;
            source += (rest % axis) * stride;
            rest /= axis;
        }
        source
    };
    (0..values.len()).map(|at| values[source(at)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend([1, 0]);
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        bytes
    }

    #[test]
    fn numbers_of_both_byte_orders_and_both_index_orders() {
        let big: Vec<u8> = [1.5_f64, -2.0].iter().flat_map(|value| value.to_be_bytes()).collect();
        let read = parse(&array("{'descr': '>f8', 'fortran_order': False, 'shape': (2,), }\n", &big)).unwrap();
        assert_eq!(read, NpyArray::Numbers { shape: vec![2], values: vec![1.5, -2.0] });
        let bytes: Vec<u8> = (0..6).collect();
        let read = parse(&array("{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3), }\n", &bytes)).unwrap();
        assert_eq!(read, NpyArray::Numbers { shape: vec![2, 3], values: vec![0.0, 2.0, 4.0, 1.0, 3.0, 5.0] });
    }

    #[test]
    fn objects_records_and_short_data_are_named() {
        let error = |header: &str, data: &[u8]| parse(&array(header, data)).unwrap_err();
        assert!(error("{'descr': '|O', 'fortran_order': False, 'shape': (2,), }", b"").contains("object array"));
        assert!(error("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (2,), }", b"").contains("records"));
        assert!(error("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", &[0; 15]).contains("15 bytes"));
        assert!(
            error("{'descr': '<f8', 'fortran_order': False, 'shape': (9999999999, 9999999999), }", b"")
                .contains("size")
        );
        assert!(parse(b"\x93NUMPY\x01").is_err());
    }
}
