//! What structures and buffers hold.

use omm_layout::object::Object as Built;
use omm_model::opacity::OpacityState;
use omm_model::special_index::TriangleMap;

use super::{Scene, Verdict, equal};
use crate::change::unknown;
use crate::error::Mistake;
use crate::node::{Arguments, Kind, Node};

impl Scene<'_> {
    /// `states("leaf", ["TOUu", "O"])`: the states of a built micromap, triangle by triangle.
    pub(super) fn states(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["of", "are"])?;
        let name = arguments.need("of")?;
        let wanted = arguments.need("are")?.list()?;
        let wanted: Vec<&str> = wanted.iter().map(Node::text).collect::<Result<_, _>>()?;
        Ok(match self.world.built(name.text()?, name)? {
            Some(Built::Micromap(micromap)) => {
                let letters = |triangle: u32| {
                    let microtriangles =
                        micromap.triangle(triangle).map_or(0, |it| it.subdivision_level.microtriangles());
                    let state = |index| micromap.state(triangle, index).map_or('?', OpacityState::letter);
                    (0..microtriangles).map(state).collect::<String>()
                };
                let found: Vec<String> = (0..micromap.triangle_count()).map(letters).collect();
                equal(&wanted.iter().map(|text| (*text).to_owned()).collect(), &found)
            }
            Some(_) => Err("it is no micromap".to_owned()),
            None => Err("nothing is built there".to_owned()),
        })
    }

    /// `maps("card", [0, T, inactive])`: which micromap triangle or special index each triangle has, in all geometries.
    pub(super) fn maps(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["of", "are"])?;
        let name = arguments.need("of")?;
        let wanted: Vec<String> = arguments.need("are")?.list()?.iter().map(Node::describe).collect();
        let found = self.geometries(name, |triangle| match triangle.map {
            Some(TriangleMap::Triangle(index)) => index.to_string(),
            Some(TriangleMap::SpecialIndex(special)) => special.state().letter().to_string(),
            None => "none".to_owned(),
        })?;
        Ok(found.and_then(|found| equal(&wanted, &found)))
    }

    /// `positions("card", [[(0, 0, 0), (1, 0, 0), (0, 1, 0)], inactive])`: the corners of each triangle.
    pub(super) fn positions(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["of", "are"])?;
        let name = arguments.need("of")?;
        let mut wanted = Vec::new();
        for triangle in arguments.need("are")?.list()? {
            if triangle.name() == Some("inactive") {
                wanted.push("inactive".to_owned());
                continue;
            }
            let mut numbers = Vec::new();
            for corner in triangle.list()? {
                let Kind::Tuple(None, values) = &corner.kind else {
                    return Err(corner.mistake("a corner is (x, y, z)"));
                };
                for value in values {
                    numbers.push(value.float()? as f32);
                }
            }
            wanted.push(format!("{numbers:?}"));
        }
        let found = self.geometries(name, |triangle| format!("{:?}", triangle.vertices.as_flattened()))?;
        Ok(found.and_then(|found| equal(&wanted, &found)))
    }

    /// What `show` makes of every triangle of a bottom level.
    fn geometries(
        &self,
        name: &Node,
        show: impl Fn(&omm_layout::object::StoredTriangle) -> String,
    ) -> Result<Result<Vec<String>, String>, Mistake> {
        let Some(Built::BottomLevel(object)) = self.world.built(name.text()?, name)? else {
            return Ok(Err("no bottom level is built there".to_owned()));
        };
        let mut found = Vec::new();
        for geometry in object.geometries() {
            let start = found.len();
            found.resize(start + geometry.primitive_count() as usize, "inactive".to_owned());
            for triangle in geometry.triangles() {
                if let Some(slot) = found.get_mut(start + triangle.primitive_index as usize) {
                    *slot = show(&triangle);
                }
            }
        }
        Ok(Ok(found))
    }

    /// `instances("scene", ["card", inactive])`: what each instance refers to.
    pub(super) fn instances(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["of", "are"])?;
        let name = arguments.need("of")?;
        let wanted = arguments.need("are")?.list()?;
        let wanted: Vec<String> = wanted.iter().map(|node| node.describe().trim_matches('"').to_owned()).collect();
        let Some(Built::TopLevel(object)) = self.world.built(name.text()?, name)? else {
            return Ok(Err("no top level is built there".to_owned()));
        };
        let reference = |address: u64| match address {
            0 => "inactive".to_owned(),
            address => {
                let name = self.world.objects.name_of_address(address, false);
                name.unwrap_or_else(|| format!("{address:#x}"))
            }
        };
        let found: Vec<String> =
            object.instances().map(|instance| reference(instance.acceleration_structure_reference())).collect();
        Ok(equal(&wanted, &found))
    }

    /// `bytes("blob + 32", "00 01")`: the bytes at an address.
    pub(super) fn bytes(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["at", "are"])?;
        let at = arguments.need("at")?;
        let address = self.world.objects.address(at.text()?).map_err(|error| unknown(at, error))?;
        let wanted = crate::given::bytes(arguments.need("are")?, &self.world.objects)?;
        let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ");
        Ok(match self.world.read(address.value, wanted.len() as u64) {
            Some(found) if found == wanted => Ok(()),
            Some(found) => Err(format!("found {}", hex(found))),
            None => Err("there are not so many bytes".to_owned()),
        })
    }

    /// `same("leaf", "twin")`: two structures hold the same bytes.
    pub(super) fn same(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["one", "other"])?;
        let (one, other) = (arguments.need("one")?, arguments.need("other")?);
        let found = (self.contents(one)?, self.contents(other)?);
        Ok(match found {
            (Some(one), Some(other)) if one == other => Ok(()),
            (Some(one), Some(other)) => {
                let at = one.iter().zip(other).position(|(one, other)| one != other);
                let at = at.unwrap_or(one.len().min(other.len()));
                Err(format!("they have {} and {} bytes and differ at {at}", one.len(), other.len()))
            }
            _ => Err("nothing is there".to_owned()),
        })
    }

    /// `smaller("small", "leaf")`: a structure takes fewer bytes than another.
    pub(super) fn smaller(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["one", "other"])?;
        let size = |name: &Node| self.contents(name).map(|bytes| bytes.map_or(0, <[u8]>::len));
        let (one, other) = (size(arguments.need("one")?)?, size(arguments.need("other")?)?);
        Ok(if one < other { Ok(()) } else { Err(format!("they have {one} and {other} bytes")) })
    }

    /// The bytes of what is built in a structure, or of all of a buffer.
    fn contents(&self, name: &Node) -> Result<Option<&[u8]>, Mistake> {
        if self.world.structures.contains_key(name.text()?) {
            return Ok(self.world.built(name.text()?, name)?.map(|object| object.as_bytes()));
        }
        let object = self.world.objects.get(name.text()?).map_err(|error| unknown(name, error))?;
        Ok(object.place.and_then(|place| self.world.read(place.address, place.size)))
    }
}
