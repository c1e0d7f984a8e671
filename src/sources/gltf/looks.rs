//! What does the JSON say of materials and textures?

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::value::RawValue;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material<'a> {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) pbr_metallic_roughness: Reflection,
    pub(super) normal_texture: Option<IgnoredAny>,
    pub(super) occlusion_texture: Option<IgnoredAny>,
    pub(super) emissive_texture: Option<TextureInfo>,
    #[serde(default)]
    pub(super) emissive_factor: [f64; 3],
    pub(super) alpha_mode: Option<String>,
    #[serde(default)]
    pub(super) double_sided: bool,
    #[serde(default)]
    pub(super) extensions: MaterialExtensions,
    #[serde(default, borrow)]
    pub(super) extras: Option<&'a RawValue>,
}

impl Material<'_> {
    /// The base colour that the texture multiplies, or the diffuse colour.
    pub(super) fn base_factor(&self) -> [f64; 3] {
        let [r, g, b, _] = match &self.extensions.specular_glossiness {
            Some(diffuse) => diffuse.diffuse_factor.unwrap_or([1.0; 4]),
            None => self.pbr_metallic_roughness.base_color_factor,
        };
        [r, g, b]
    }

    /// The texture of that colour, and the field that gives it.
    pub(super) fn base_texture(&self) -> Option<(&TextureInfo, &'static str)> {
        match &self.extensions.specular_glossiness {
            Some(diffuse) => {
                let name = "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture";
                diffuse.diffuse_texture.as_ref().map(|texture| (texture, name))
            }
            None => {
                let texture = self.pbr_metallic_roughness.base_color_texture.as_ref();
                texture.map(|texture| (texture, "pbrMetallicRoughness.baseColorTexture"))
            }
        }
    }

    /// Whether the base colour lies outside of what reflects.
    pub(super) fn is_clamped(&self) -> bool {
        self.base_factor().iter().any(|channel| !(0.0..=1.0).contains(channel))
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Reflection {
    pub(super) base_color_factor: [f64; 4],
    pub(super) base_color_texture: Option<TextureInfo>,
    pub(super) metallic_factor: f64,
}

impl Default for Reflection {
    fn default() -> Self {
        Self { base_color_factor: [1.0; 4], base_color_texture: None, metallic_factor: 1.0 }
    }
}

#[derive(Deserialize, Default)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub(super) emissive_strength: Option<EmissiveStrength>,
    #[serde(rename = "KHR_materials_unlit")]
    pub(super) unlit: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub(super) specular_glossiness: Option<SpecularGlossiness>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SpecularGlossiness {
    pub(super) diffuse_factor: Option<[f64; 4]>,
    pub(super) diffuse_texture: Option<TextureInfo>,
}

/// Which texture, and how it lies on the surface.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub(super) index: u32,
    #[serde(default)]
    pub(super) tex_coord: u32,
    #[serde(default)]
    pub(super) extensions: TextureInfoExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<TextureTransform>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    pub(super) offset: Option<[f64; 2]>,
    pub(super) rotation: Option<f64>,
    pub(super) scale: Option<[f64; 2]>,
    pub(super) tex_coord: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct Texture {
    pub(super) source: Option<u32>,
    pub(super) sampler: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub(super) uri: Option<String>,
    pub(super) buffer_view: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Sampler {
    pub(super) wrap_s: Option<u32>,
    pub(super) wrap_t: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct EmissiveStrength {
    #[serde(rename = "emissiveStrength")]
    pub(super) strength: Option<f64>,
}
