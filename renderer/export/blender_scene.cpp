// SPDX-License-Identifier: MIT
#include "renderer/export/blender_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/export/data_folder.h"
#include "renderer/export/ply_file.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/scene/cores/composite.h"
#include "renderer/scene/cores/texture.h"
#include "renderer/scene/graph.h"
#include "renderer/scene/stores/tessellation.h"

namespace rtrays {

namespace {

using Json = nlohmann::json;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

/// Returns the smallest luminance of the texels, decoded.
double darkest_texel(const TextureImage &image) {
    const size_t texels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    double darkest = HUGE_VAL;
    for (size_t i = 0; i < texels; ++i) {
        Eigen::Vector3d rgb;
        for (size_t c = 0; c < 3; ++c) {
            rgb[static_cast<Eigen::Index>(c)] = decoded_channel(image, 3 * i + c);
        }
        darkest = std::min(darkest, luminance(rgb));
    }
    return darkest;
}

/// Returns whether Cycles reflects light like a mirror at some point of a rough surface: where
/// alpha_x * alpha_y <= 1e-7 (bsdf_microfacet_ggx_sample and similar).
bool is_mirror_in_cycles(const BxdfComponent &part, const TextureArrays &textures) {
    double factor = 1;
    if (part.roughness_texture != no_index) {
        factor = darkest_texel(*textures.image[part.roughness_texture]);
        factor *= part.roughness_squared ? factor : 1;
    }
    return part.alpha.prod() * factor * factor <= 1.01e-7;
}

/// Returns why Cycles of Blender 3.4 cannot render a component, or an empty text if it can. See
/// intern/cycles/kernel/closure/bsdf_*.h and kernel/svm/closure.h in its sources.
std::string missing_in_cycles(const BxdfComponent &part, const TextureArrays &textures) {
    if (part.side != BxdfComponent::Side::both) {
        return "the export has no materials that differ by side";
    }
    if (part.fresnel == Fresnel::thin_dielectric) {
        return "the export has no thin plates";
    }
    if (part.mix_texture != no_index) {
        return "the export writes no mixture by a texture";
    }
    switch (part.kind) {
        case Kind::lambert:
            return part.fresnel == Fresnel::ideal || part.fresnel_of_wo
                       ? ""
                       : "the Fresnel term of its diffuse components depends on the view direction "
                         "alone, not on the direction of the light";
        case Kind::coated_lambert:
            return "it has no diffuse reflection under a coat";
        case Kind::oren_nayar:
            return "its Oren-Nayar model differs (Fujii's, normalised)";
        case Kind::ideal_reflection:
        case Kind::ideal_refraction:
            return "";
        case Kind::microfacet_reflection:
            if (part.fresnel != Fresnel::ideal) {
                return "its Glossy BSDF has no Fresnel term, and its rough Glass BSDF evaluates "
                       "the term at the normal instead of the half vector";
            }
            if (part.alpha[0] != part.alpha[1]) {
                return "its tangents on meshes differ";
            }
            return is_mirror_in_cycles(part, textures)
                       ? "it treats a surface of such low roughness as a mirror"
                       : "";
        case Kind::microfacet_refraction:
            return "its rough Glass BSDF evaluates the Fresnel term at the normal instead of the "
                   "half vector";
        case Kind::blinn:
        case Kind::ward:
        case Kind::ward_original:
        case Kind::disney_diffuse:
        case Kind::disney_sheen:
        case Kind::disney_clearcoat:
            return "it has no such model";
    }
    throw run_error("unknown kind of BxDF component");
}

/// Grid of shapes that emit, which is coarser: Cycles samples the triangles of lights by a float,
/// and the more there are, the darker it renders them. Three spheres
/// (scenes/analytic/three_lamps.json) become up to 0.02 % too dark with 64 columns each, 0.1 % with
/// 128 and 0.4 % with 256. The projected disc of a sphere of 64 columns differs from the exact one
/// by at most 9e-4 from any side, 2e-4 in the root mean square.
constexpr TessellationGrid bright_grid{32, 64};

/// Returns the components of a vector as an array.
template <typename Vector>
Json numbers(const Vector &vector) {
    Json array = Json::array();
    for (Eigen::Index i = 0; i < vector.size(); ++i) {
        array.push_back(vector[i]);
    }
    return array;
}

/// Returns a matrix as an array of rows.
Json matrix(const Eigen::Matrix4d &values) {
    Json rows = Json::array();
    for (int row = 0; row < 4; ++row) {
        rows.push_back(numbers(Eigen::Vector4d(values.row(row))));
    }
    return rows;
}

class SceneWriter {
  public:
    SceneWriter(const Scene &scene, const std::filesystem::path &path)
        : scene_(scene), arrays_(scene.arrays()), folder_(path) {}

    Json write(const ExportSettings &settings) {
        // Before any file is written, so that a scene that cannot be represented leaves no files.
        Json materials = write_materials();
        require_triangles();
        Json meshes = Json::array(), textures = Json::array(), lights = Json::array();
        for (uint32_t mesh = 0; mesh < arrays_.meshes.name.size(); ++mesh) {
            meshes.push_back(write_mesh(arrays_.meshes, mesh));
        }
        for (uint32_t shape = 0; shape < arrays_.shapes.name.size(); ++shape) {
            const bool is_bright = arrays_.shapes.light[shape] != no_index;
            meshes.push_back(write_mesh(
                tessellated(arrays_.shapes, shape, is_bright ? bright_grid : TessellationGrid()),
                0));
        }
        for (uint32_t texture = 0; texture < arrays_.textures.name.size(); ++texture) {
            textures.push_back(write_texture(texture));
        }
        for (uint32_t light = 0; light < arrays_.lights.name.size(); ++light) {
            // Area lights are written with their surface.
            if (arrays_.lights.kind[light] != LightArrays::Kind::diffuse_area) {
                lights.push_back(write_light(light));
            }
        }
        return {{"format", "rtrays scene for Blender"},
                {"version", 1},
                {"name", scene_.name()},
                {"samples_per_pixel", settings.samples_per_pixel},
                {"max_depth", settings.max_depth},
                {"film", {{"width", scene_.film_width()}, {"height", scene_.film_height()}}},
                {"camera", write_camera()},
                {"materials", std::move(materials)},
                {"textures", std::move(textures)},
                {"meshes", std::move(meshes)},
                {"lights", std::move(lights)}};
    }

  private:
    Json write_camera() const {
        const CameraArrays &cameras = arrays_.cameras;
        const auto i = static_cast<size_t>(scene_.active_camera());
        if (scene_.crop()) {
            throw input_error("film: the export to Cycles does not support a crop");
        }
        if (cameras.is_orthographic(i)) {
            throw input_error(
                fmt::format("camera '{}': the export to Cycles does not support orthographic "
                            "cameras",
                            cameras.name[i]));
        }
        using Axis = CameraArrays::FovAxis;
        const bool wide = scene_.film_width() >= scene_.film_height();
        const Axis axis = cameras.fov_axis[i];
        const bool along_x =
            axis == Axis::x || (axis == Axis::larger && wide) || (axis == Axis::smaller && !wide);
        const Eigen::AlignedBox3d bounds = scene_.graph().bounds();
        const Eigen::Vector3d eye =
            scene_.origin() + Eigen::Vector3d(cameras.world_from_camera[i].topRightCorner<3, 1>());
        const double extent = bounds.isEmpty() ? 1
                                               : std::sqrt(bounds.squaredExteriorDistance(eye)) +
                                                     bounds.diagonal().norm();
        return {{"name", cameras.name[i]},
                {"world_from_camera", matrix(cameras.world_from_camera[i])},
                {"fov", cameras.fov[i]},
                {"fov_axis", along_x ? "x" : "y"},
                {"aperture_radius", cameras.aperture_radius[i]},
                {"focus_distance", cameras.focus_distance[i]},
                {"extent", extent}};
    }

    Json write_materials() const {
        const MaterialArrays &materials = arrays_.materials;
        Json list = Json::array();
        for (uint32_t i = 0; i < materials.name.size(); ++i) {
            if (materials.normal_map[i].kind != NormalMap::Kind::none) {
                throw input_error(fmt::format(
                    "{}material '{}': the export to Cycles does not support normal and bump maps",
                    user_of(i), materials.name[i]));
            }
            Json components = Json::array();
            for (uint32_t c = 0; c < materials.component_count[i]; ++c) {
                const BxdfComponent &part = materials.component[materials.first_component[i] + c];
                const std::string missing = missing_in_cycles(part, arrays_.textures);
                if (!missing.empty() && !part.weight.isZero(0)) {
                    const std::string name = bxdf_names()[static_cast<size_t>(part.kind)];
                    const std::string term = fresnel_names()[static_cast<size_t>(part.fresnel)];
                    throw input_error(fmt::format(
                        "{}material '{}', component {} ({}{}{}): not supported by Cycles: {}",
                        user_of(i), materials.name[i], c, name,
                        part.fresnel == Fresnel::ideal ? "" : " with Fresnel term ",
                        part.fresnel == Fresnel::ideal ? "" : term, missing));
                }
                components.push_back(write_component(part));
            }
            Json material = {{"name", materials.name[i]},
                             {"two_sided", materials.two_sided[i] != 0},
                             {"components", std::move(components)}};
            if (!materials.opacity[i].is_opaque()) {
                material["opacity"] = write_opacity(materials.opacity[i]);
            }
            if (materials.emission_texture[i] != no_index) {
                material["emission_texture"] = materials.emission_texture[i];
            }
            list.push_back(std::move(material));
        }
        return list;
    }

    /// Returns "'NODE': " for the first object of a material, or an empty text.
    std::string user_of(uint32_t material) const {
        const auto of = [&](const std::vector<uint32_t> &users,
                            const std::vector<std::string> &names) {
            const auto found = std::find(users.begin(), users.end(), material);
            return found == users.end() ? std::string()
                                        : names[static_cast<size_t>(found - users.begin())];
        };
        const std::string mesh = of(arrays_.meshes.material, arrays_.meshes.name);
        const std::string shape = of(arrays_.shapes.material, arrays_.shapes.name);
        const std::string &name = mesh.empty() ? shape : mesh;
        return name.empty() ? "" : "'" + name + "': ";
    }

    static Json write_opacity(const MaterialOpacity &opacity) {
        Json json = {{"value", opacity.value}, {"cutoff", opacity.cutoff}};
        if (opacity.texture != no_index) {
            json["texture"] = opacity.texture;
        }
        return json;
    }

    static Json write_component(const BxdfComponent &part) {
        Json component = {{"kind", bxdf_names()[static_cast<size_t>(part.kind)]},
                          {"weight", numbers(part.weight)},
                          {"fresnel", fresnel_names()[static_cast<size_t>(part.fresnel)]},
                          {"complement", part.complement},
                          {"eta", numbers(part.eta)},
                          {"k", numbers(part.k)}};
        if (part.kind == Kind::microfacet_reflection) {
            component["distribution"] =
                part.distribution == BxdfComponent::Distribution::ggx ? "ggx" : "beckmann";
            component["alpha"] = part.alpha[0];
            if (part.roughness_texture != no_index) {
                component["roughness_texture"] = part.roughness_texture;
                component["roughness_squared"] = part.roughness_squared;
            }
        }
        if (part.texture != no_index) {
            component["texture"] = part.texture;
        }
        return component;
    }

    Json write_texture(uint32_t i) {
        const TextureArrays &textures = arrays_.textures;
        if (textures.wrap[i] == TextureArrays::Wrap::mirror) {
            throw input_error(
                fmt::format("texture '{}': the export to Cycles does not support the wrap mode "
                            "mirror",
                            textures.name[i]));
        }
        if (textures.has_vertex_colours(i)) {
            throw input_error(
                fmt::format("texture '{}': the export to Cycles does not support vertex colours",
                            textures.name[i]));
        }
        return {{"name", textures.name[i]},
                {"file", image_file(textures.image[i], textures.name[i])},
                {"filter",
                 textures.filter[i] == TextureArrays::Filter::nearest ? "nearest" : "bilinear"},
                {"wrap", textures.wrap[i] == TextureArrays::Wrap::clamp ? "clamp" : "repeat"},
                {"uv_scale", numbers(textures.uv_scale[i])},
                {"uv_offset", numbers(textures.uv_offset[i])}};
    }

    /// Returns the file of an image as linear floats, which is written on first use.
    std::string image_file(const std::shared_ptr<const TextureImage> &image,
                           const std::string &name) {
        std::string &file = images_[image.get()];
        if (file.empty()) {
            TextureImage linear = *image;
            if (linear.floats.empty()) {
                for (size_t i = 0; i < linear.bytes.size(); ++i) {
                    linear.floats.push_back(static_cast<float>(decoded_channel(*image, i)));
                }
                linear.bytes.clear();
            }
            const std::filesystem::path path = folder_.new_file(name, ".exr");
            write_texture_file(linear, path);
            file = folder_.relative(path);
        }
        return file;
    }

    Json write_mesh(const MeshArrays &meshes, uint32_t i) {
        const std::filesystem::path file = folder_.new_file(meshes.name[i], ".ply");
        write_ply(meshes, i, file);
        Json mesh = {{"name", meshes.name[i]},
                     {"file", folder_.relative(file)},
                     {"vertices", meshes.vertex_count[i]},
                     {"triangles", meshes.triangle_count[i]},
                     {"has_normals", meshes.has_normals[i] != 0},
                     {"has_uv", meshes.has_uv[i] != 0},
                     {"material", meshes.material[i]}};
        if (meshes.light[i] != no_index) {
            mesh["radiance"] = numbers(arrays_.lights.radiance[meshes.light[i]]);
        }
        return mesh;
    }

    void require_triangles() const {
        const ShapeArrays &shapes = arrays_.shapes;
        for (size_t i = 0; i < shapes.name.size(); ++i) {
            if (!can_be_tessellated(shapes.kind[i])) {
                throw input_error(fmt::format(
                    "'{}': Cycles supports only triangles, which cannot represent this {}",
                    shapes.name[i],
                    shapes.kind[i] == ShapeArrays::Kind::plane ? "unbounded plane" : "Julia set"));
            }
        }
    }

    Json write_light(uint32_t i) {
        const LightArrays &lights = arrays_.lights;
        constexpr const char *names[] = {"diffuse_area", "point", "spot",
                                         "directional",  "dome",  "environment"};
        Json light = {{"name", lights.name[i]},
                      {"kind", names[static_cast<size_t>(lights.kind[i])]},
                      {"radiance", numbers(lights.radiance[i])},
                      {"world_from_light", matrix(lights.world_from_light[i])},
                      {"inner_angle", lights.inner_angle[i]},
                      {"outer_angle", lights.outer_angle[i]}};
        if (lights.kind[i] == LightArrays::Kind::environment) {
            light["file"] = image_file(lights.image[i], lights.name[i]);
        }
        return light;
    }

    const Scene &scene_;
    const SceneArrays &arrays_;
    DataFolder folder_;
    std::map<const TextureImage *, std::string> images_;
};

}  // namespace

void export_blender_scene(const Scene &scene, const std::filesystem::path &path,
                          const ExportSettings &settings) {
    require_writable(path);
    write_file(path, SceneWriter(scene, path).write(settings).dump(1) + "\n");
}

}  // namespace rtrays
