//! Bytes as a scenario writes them.

use crate::error::Mistake;
use crate::limits;
use crate::node::{Kind, Node};
use crate::objects::Objects;

/// The bytes of `"00 1f ff"`, of `[0, 31, 255]`, of `u16([1, 2])` and its like for `u8`, `u32`, `u64` and `f32`, of
/// `address("leaf")`, of `zeros(64)`, and of lists of all these.
pub(crate) fn bytes(node: &Node, objects: &Objects) -> Result<Vec<u8>, Mistake> {
    let mut out = Vec::new();
    append(node, objects, &mut out)?;
    Ok(out)
}

fn append(node: &Node, objects: &Objects, out: &mut Vec<u8>) -> Result<(), Mistake> {
    let only = |values: &'_ [Node]| match values {
        [only] => Ok(only.clone()),
        _ => Err(node.mistake("one value is needed")),
    };
    match (&node.kind, node.head()) {
        (Kind::Text(text), _) => {
            let digits: String = text.split_whitespace().collect();
            if !digits.is_ascii() || digits.len() % 2 == 1 {
                return Err(node.mistake("bytes in quotes are pairs of hexadecimal digits"));
            }
            for at in (0..digits.len()).step_by(2) {
                let byte = u8::from_str_radix(digits.get(at..at + 2).unwrap_or_default(), 16);
                out.push(byte.map_err(|_| node.mistake("bytes in quotes are pairs of hexadecimal digits"))?);
            }
        }
        (Kind::Integer(_), _) => out.push(node.integer()?),
        (Kind::List(nodes), _) => nodes.iter().try_for_each(|node| append(node, objects, out))?,
        (Kind::Tuple(_, values), Some(head @ ("u8" | "u16" | "u32" | "u64"))) => {
            let size = match head {
                "u8" => 1,
                "u16" => 2,
                "u32" => 4,
                _ => 8,
            };
            for number in only(values)?.one_or_more() {
                out.extend(integer(number, size)?);
            }
        }
        (Kind::Tuple(_, values), Some("f32")) => {
            for number in only(values)?.one_or_more() {
                out.extend((number.float()? as f32).to_le_bytes());
            }
        }
        (Kind::Tuple(_, values), Some("address")) => {
            let name = only(values)?;
            let found = objects.address(name.text()?);
            let found = found.map_err(|unknown| crate::change::unknown(&name, unknown))?;
            out.extend(found.value.to_le_bytes());
        }
        (Kind::Tuple(_, values), Some("zeros")) => {
            let count: u64 = only(values)?.integer()?;
            if count > limits::BYTES {
                return Err(node.mistake(format!("{count} bytes are more than the {} of a scenario", limits::BYTES)));
            }
            out.resize(out.len() + count as usize, 0);
        }
        _ => return Err(node.mistake(format!("{} stands for no bytes", node.describe()))),
    }
    Ok(())
}

/// The bytes of a number that may have a sign.
fn integer(node: &Node, size: usize) -> Result<Vec<u8>, Mistake> {
    let number: i128 = node.integer()?;
    let bits = 8 * size;
    if !(-(1_i128 << (bits - 1))..1 << bits).contains(&number) {
        return Err(node.mistake(format!("{number} does not fit into {bits} bits")));
    }
    Ok(number.to_le_bytes().into_iter().take(size).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_written_in_many_ways() {
        let of = |text: &str| {
            bytes(&crate::node::read(text).unwrap(), &Objects::default()).map_err(|mistake| mistake.message)
        };
        assert_eq!(of("\"00 1f Ff\""), Ok(vec![0, 0x1f, 0xff]));
        assert_eq!(
            of("[1, u16([2, -1]), [u32(3)], f32(1.0), zeros(2)]").unwrap(),
            [1, 2, 0, 255, 255, 3, 0, 0, 0, 0, 0, 0x80, 0x3f, 0, 0]
        );
        for wrong in
            ["256", "u16(65536)", "\"0\"", "\"0g\"", "\"é0\"", "zeros(99999999999)", "x", "u64([[1]])", "u8(1, 2)"]
        {
            assert!(of(wrong).is_err(), "{wrong}");
        }
    }
}
