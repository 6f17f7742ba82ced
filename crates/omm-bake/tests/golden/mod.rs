//! Reading golden jobs and a peer's answers to them.

use std::path::{Path, PathBuf};

use omm_bake::{AddressMode, BakeOptions, Filter, LevelChoice, Sampler, Texture, UnknownStatePromotion};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use serde::Deserialize;

/// Where golden data lies: `OMM_GOLDEN`, or beside the workspace.
pub fn folder() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/golden");
    std::env::var_os("OMM_GOLDEN").map_or(beside, PathBuf::from)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JobFile {
    name: String,
    texture: TextureFile,
    uvs: String,
    triangles: String,
    format: String,
    max_level: u32,
    dynamic_subdivision_scale: Option<f32>,
    address_mode: AddressMode,
    filter: Filter,
    border_alpha: f32,
    alpha_cutoff: f32,
    unknown_state_promotion: UnknownStatePromotion,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TextureFile {
    path: String,
    width: u32,
    height: u32,
    format: String,
}

pub struct Job {
    pub name: String,
    pub texels: Vec<u8>,
    pub texture: Texture,
    pub uvs: Vec<[f32; 2]>,
    pub triangles: Vec<[u32; 3]>,
    pub options: BakeOptions,
}

fn words<const N: usize>(path: &Path) -> Vec<[u32; N]> {
    let bytes = std::fs::read(path).unwrap();
    let words: Vec<u32> = bytes.chunks_exact(4).map(|c| u32::from_le_bytes(c.try_into().unwrap())).collect();
    words.chunks_exact(N).map(|chunk| chunk.try_into().unwrap()).collect()
}

pub fn jobs(folder: &Path) -> Vec<Job> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.to_string_lossy().ends_with(".job.json"));
    files.sort();
    files.iter().map(|path| read_job(folder, path)).collect()
}

fn read_job(folder: &Path, path: &Path) -> Job {
    let file: JobFile = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    assert_eq!(file.texture.format, "unorm8");
    let texels = std::fs::read(folder.join(&file.texture.path)).unwrap();
    let max = SubdivisionLevel::new(file.max_level).unwrap();
    let level =
        file.dynamic_subdivision_scale.map_or(LevelChoice::Uniform(max), |scale| LevelChoice::Dynamic { scale, max });
    Job {
        name: file.name,
        texture: Texture::unorm8(file.texture.width, file.texture.height, texels.clone()).unwrap(),
        texels,
        uvs: words(&folder.join(&file.uvs)).into_iter().map(|uv: [u32; 2]| uv.map(f32::from_bits)).collect(),
        triangles: words(&folder.join(&file.triangles)),
        options: BakeOptions {
            format: match file.format.as_str() {
                "2-state" => OpacityMicromapFormat::TwoState,
                "4-state" => OpacityMicromapFormat::FourState,
                other => panic!("format {other}"),
            },
            level,
            sampler: Sampler::new(file.address_mode, file.filter, file.border_alpha),
            alpha_cutoff: file.alpha_cutoff,
            promotion: file.unknown_state_promotion,
            ..BakeOptions::default()
        },
    }
}

/// What one triangle of the mesh got.
pub enum Entry<'a> {
    Special(OpacityState),
    Block { level: u32, format: OpacityMicromapFormat, data: &'a [u8] },
}

impl Entry<'_> {
    /// The state of microtriangle `index`.
    pub fn state(&self, index: u32) -> OpacityState {
        match self {
            Self::Special(state) => *state,
            Self::Block { format, data, .. } => format.state(data, index.into()).unwrap(),
        }
    }
}

/// A peer's answer: array, triangles of 8 bytes, indices.
pub struct Peer {
    array: Vec<u8>,
    triangles: Vec<[u32; 2]>,
    indices: Vec<[u32; 1]>,
}

impl Peer {
    pub fn read(folder: &Path, name: &str) -> Option<Self> {
        let path = |what| folder.join(format!("{name}.{what}.bin"));
        let array = std::fs::read(path("array")).ok()?;
        Some(Self { array, triangles: words(&path("desc")), indices: words(&path("index")) })
    }

    pub fn entry(&self, triangle: usize) -> Entry<'_> {
        entry(&self.array, &self.triangles, self.indices[triangle][0] as i32)
    }
}

pub fn entry<'a>(array: &'a [u8], triangles: &[[u32; 2]], index: i32) -> Entry<'a> {
    match OpacityMicromapSpecialIndex::from_value(index) {
        Some(special) => Entry::Special(special.state()),
        None => {
            let [offset, level_and_format] = triangles[index as usize];
            let level = level_and_format & 0xffff;
            let format = OpacityMicromapFormat::from_value(level_and_format >> 16).unwrap();
            Entry::Block { level, format, data: &array[offset as usize..] }
        }
    }
}
