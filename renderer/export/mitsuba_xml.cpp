// SPDX-License-Identifier: MIT
#include "renderer/export/mitsuba_xml.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <type_traits>

#include "renderer/base/angles.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/export/mitsuba_bsdf.h"
#include "renderer/export/mitsuba_writer.h"
#include "renderer/export/ply_file.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/import/mitsuba/envmap.h"
#include "renderer/scene/cores/shape.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/graph.h"
#include "renderer/scene/stores/pose.h"
#include "renderer/scene/stores/tessellation.h"

namespace rtrays {

namespace {

using namespace mitsuba;
using Eigen::Matrix4d;
using Eigen::Vector3d;

/// Returns whether the normals of a triangle are on its back.
bool opposes_its_normals(const MeshArrays &meshes, const Triangle &t) {
    const Eigen::Vector3f &a = meshes.position[t[0]];
    const Eigen::Vector3f front = (meshes.position[t[1]] - a).cross(meshes.position[t[2]] - a);
    return front.dot(meshes.normal[t[0]] + meshes.normal[t[1]] + meshes.normal[t[2]]) < 0;
}

/// Returns a mesh as the only one of its arrays, with the normals of each triangle on its front.
/// The winding decides the side here, but the normals decide it in Mitsuba.
MeshArrays with_normals_in_front(const MeshArrays &meshes, uint32_t mesh) {
    const auto part = [&](const auto &values) {
        using Values = std::decay_t<decltype(values)>;
        const auto first = values.begin() + meshes.first_vertex[mesh];
        return values.empty() ? Values() : Values(first, first + meshes.vertex_count[mesh]);
    };
    MeshArrays result;
    result.position = part(meshes.position);
    result.normal = part(meshes.normal);
    result.uv = part(meshes.uv);
    result.colour = part(meshes.colour);
    std::map<uint32_t, uint32_t> turned;  // vertices with the opposite normal
    const auto first = meshes.triangle.begin() + meshes.first_triangle[mesh];
    for (auto t = first; t != first + meshes.triangle_count[mesh]; ++t) {
        const bool opposes = opposes_its_normals(meshes, *t);
        Triangle &made = result.triangle.emplace_back();
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t vertex = (*t)[i] - meshes.first_vertex[mesh];
            made[i] = vertex;
            if (opposes) {
                const auto next = static_cast<uint32_t>(result.position.size());
                const auto [copy, is_new] = turned.emplace(vertex, next);
                made[i] = copy->second;
                if (is_new) {
                    result.position.push_back(meshes.position[(*t)[i]]);
                    result.normal.push_back(-meshes.normal[(*t)[i]]);
                    if (!result.uv.empty()) {
                        result.uv.push_back(meshes.uv[(*t)[i]]);
                    }
                    if (!result.colour.empty()) {
                        result.colour.push_back(meshes.colour[(*t)[i]]);
                    }
                }
            }
        }
    }
    result.first_triangle = {0};
    result.triangle_count = {meshes.triangle_count[mesh]};
    result.first_vertex = {0};
    result.vertex_count = {static_cast<uint32_t>(result.position.size())};
    result.has_normals = {1};
    result.has_uv = {meshes.has_uv[mesh]};
    return result;
}

class SceneWriter {
  public:
    SceneWriter(const Scene &scene, const std::filesystem::path &path, pugi::xml_node root)
        : scene_(scene),
          arrays_(scene.arrays()),
          root_(root),
          folder_(path),
          bsdfs_(arrays_, root, ids_, folder_) {}

    void write(const ExportSettings &settings) {
        root_.append_attribute("version") = "3.0.0";
        add_default("spp", fmt::format("{}", settings.samples_per_pixel));
        // Mitsuba's depth counts one more, for the camera's own vertex; -1 means no limit.
        add_default("max_depth", settings.max_depth == 0
                                     ? "-1"
                                     : fmt::format("{}", uint64_t{settings.max_depth} + 1));
        // Shadow rays of `path` are blocked by masks, those of `volpath` pass.
        const std::vector<MaterialOpacity> &opacities = arrays_.materials.opacity;
        const bool is_opaque =
            std::all_of(opacities.begin(), opacities.end(),
                        [](const MaterialOpacity &opacity) { return opacity.is_opaque(); });
        add_property(add_object(root_, "integrator", is_opaque ? "path" : "volpath"), "integer",
                     "max_depth", "$max_depth");
        reserve_names();
        write_camera();
        for (uint32_t mesh = 0; mesh < arrays_.meshes.name.size(); ++mesh) {
            write_mesh(arrays_.meshes, mesh);
        }
        for (uint32_t shape = 0; shape < arrays_.shapes.name.size(); ++shape) {
            write_shape(shape);
        }
        for (uint32_t light = 0; light < arrays_.lights.name.size(); ++light) {
            write_light(light);
        }
    }

  private:
    /// Reserves the names of nodes, so that materials of the same names get other ones.
    void reserve_names() {
        for (const auto *names : {&arrays_.cameras.name, &arrays_.meshes.name, &arrays_.shapes.name,
                                  &arrays_.lights.name}) {
            for (const std::string &name : *names) {
                ids_.reserve(name);
            }
        }
    }

    void add_default(const char *name, const std::string &value) {
        pugi::xml_node node = root_.append_child("default");
        node.append_attribute("name") = name;
        node.append_attribute("value") = value.c_str();
    }

    /// Returns the transform from the baked world to the world of the scene file.
    Matrix4d placed(const Matrix4d &world) const { return translation(scene_.origin()) * world; }

    void write_camera() {
        const CameraArrays &cameras = arrays_.cameras;
        const auto camera = static_cast<size_t>(scene_.active_camera());
        const bool lens = cameras.aperture_radius[camera] > 0;
        const bool parallel = cameras.is_orthographic(camera);
        const pugi::xml_node sensor = add_object(root_, "sensor",
                                                 parallel ? "orthographic"
                                                 : lens   ? "thinlens"
                                                          : "perspective",
                                                 cameras.name[camera]);
        if (!parallel) {
            constexpr const char *axes[] = {"x", "y", "smaller", "larger"};
            add_property(sensor, "string", "fov_axis",
                         axes[static_cast<size_t>(cameras.fov_axis[camera])]);
            add_number(sensor, "fov", cameras.fov[camera] / degree);
        }
        if (lens) {
            add_number(sensor, "aperture_radius", cameras.aperture_radius[camera]);
            add_number(sensor, "focus_distance", cameras.focus_distance[camera]);
        }
        const Matrix4d world = placed(cameras.world_from_camera[camera]);
        // This renderer does not clip; Mitsuba's clipping planes are set to enclose the scene.
        const Eigen::AlignedBox3d bounds = scene_.graph().bounds();
        const Vector3d eye = world.topRightCorner<3, 1>();
        const double extent = bounds.isEmpty() ? 1
                                               : std::sqrt(bounds.squaredExteriorDistance(eye)) +
                                                     bounds.diagonal().norm();
        if (extent > 0) {
            add_number(sensor, "near_clip", 1e-5 * extent);
            add_number(sensor, "far_clip", 1e3 * extent);
        }
        // Mitsuba's cameras look along +z. The width of an orthographic view is 2, times its scale.
        const double scale = parallel ? 0.5 * view_width(cameras, camera) : 1;
        add_transform(sensor, world * scaling({-scale, scale, -1}));
        add_property(add_object(sensor, "sampler", "independent"), "integer", "sample_count",
                     "$spp");
        const pugi::xml_node film = add_object(sensor, "film", "hdrfilm");
        add_property(film, "integer", "width", fmt::format("{}", scene_.film_width()));
        add_property(film, "integer", "height", fmt::format("{}", scene_.film_height()));
        if (const auto &crop = scene_.crop()) {
            const std::pair<const char *, int> window[] = {{"crop_offset_x", crop->x},
                                                           {"crop_offset_y", crop->y},
                                                           {"crop_width", crop->width},
                                                           {"crop_height", crop->height}};
            for (const auto &[name, value] : window) {
                add_property(film, "integer", name, fmt::format("{}", value));
            }
        }
        add_property(film, "string", "pixel_format", "rgb");
        add_property(film, "string", "component_format", "float32");
        add_object(film, "rfilter", "box");
    }

    /// Returns the width of the view of an orthographic camera.
    double view_width(const CameraArrays &cameras, size_t camera) const {
        using Axis = CameraArrays::FovAxis;
        const double width = scene_.film_width(), height = scene_.film_height();
        const Axis axis = cameras.fov_axis[camera];
        const bool along_x = axis == Axis::x || (axis == Axis::smaller && width <= height) ||
                             (axis == Axis::larger && width >= height);
        return cameras.view_size[camera] * (along_x ? 1 : width / height);
    }

    /// Appends a shape with its BSDF (which precedes it) and its emitter.
    pugi::xml_node add_shape(const char *type, const std::string &name, uint32_t material,
                             uint32_t light, UvConvention uv) {
        std::string bsdf;
        try {
            bsdf = bsdfs_.id(material, uv);
            if (type != std::string("ply") && bsdfs_.has_vertex_colours(material)) {
                throw input_error("Mitsuba's meshes alone have vertex colours; use a mesh");
            }
        } catch (const Error &error) {
            throw Error(error.exit_code(), fmt::format("'{}': {}", name, error.what()));
        }
        const pugi::xml_node shape = add_object(root_, "shape", type, name);
        pugi::xml_node reference = pugi::xml_node(shape).append_child("ref");
        reference.append_attribute("id") = bsdf.c_str();
        if (light != no_index) {
            bsdfs_.write_radiance(add_object(shape, "emitter", "area"),
                                  arrays_.lights.radiance[light], material, uv);
        }
        return shape;
    }

    void write_mesh(const MeshArrays &meshes, uint32_t mesh) {
        const bool has_uv = meshes.has_uv[mesh] != 0;
        const bool with_colours = bsdfs_.has_vertex_colours(meshes.material[mesh]);
        const pugi::xml_node shape =
            add_shape("ply", meshes.name[mesh], meshes.material[mesh], meshes.light[mesh],
                      has_uv ? UvConvention::flipped : UvConvention::none);
        const std::filesystem::path file = folder_.new_file(meshes.name[mesh], ".ply");
        const auto first = meshes.triangle.begin() + meshes.first_triangle[mesh];
        if (meshes.has_normals[mesh] != 0 &&
            std::any_of(first, first + meshes.triangle_count[mesh],
                        [&](const Triangle &t) { return opposes_its_normals(meshes, t); })) {
            write_ply(with_normals_in_front(meshes, mesh), 0, file, with_colours);
        } else {
            write_ply(meshes, mesh, file, with_colours);
        }
        add_property(shape, "string", "filename", folder_.relative(file));
        add_boolean(shape, "face_normals", meshes.has_normals[mesh] == 0);
        if (has_uv) {
            add_boolean(shape, "flip_tex_coords", true);
        }
        if (!scene_.origin().isZero(0)) {
            add_transform(shape, translation(scene_.origin()));
        }
    }

    void write_shape(uint32_t index) {
        const ShapeArrays &shapes = arrays_.shapes;
        const std::string &name = shapes.name[index];
        const Matrix4d world = placed(shapes.world_from_object[index]);
        const auto add = [&](const char *type, UvConvention uv) {
            return add_shape(type, name, shapes.material[index], shapes.light[index], uv);
        };
        switch (shapes.kind[index]) {
            case ShapeArrays::Kind::sphere:
                if (similarity_scale(world) > 0) {
                    const pugi::xml_node shape = add("sphere", UvConvention::flipped);
                    // Mitsuba's spheres exchange their sides where the transform mirrors.
                    if (world.topLeftCorner<3, 3>().determinant() < 0) {
                        add_boolean(shape, "flip_normals", true);
                    }
                    add_transform(shape, world);
                    return;
                }
                break;
            case ShapeArrays::Kind::cylinder:
                if (is_upright_circle(world)) {
                    write_cylinder(add("cylinder", UvConvention::same), world);
                    return;
                }
                break;
            case ShapeArrays::Kind::disc:
                if (is_orthogonal(world.col(0).head<3>(), world.col(1).head<3>())) {
                    add_transform(add("disk", UvConvention::none), world);
                    return;
                }
                break;
            default:
                break;
        }
        if (!can_be_tessellated(shapes.kind[index])) {
            throw input_error(fmt::format("'{}': Mitsuba has no {}, and it cannot be tessellated",
                                          name, kind_name(shapes.kind[index])));
        }
        write_mesh(tessellated(shapes, index), 0);
    }

    static std::string kind_name(ShapeArrays::Kind kind) {
        const auto found = std::find_if(shape_types().begin(), shape_types().end(),
                                        [&](const ShapeType &type) { return type.kind == kind; });
        return found->name;  // every kind has a type
    }

    static bool is_orthogonal(const Vector3d &a, const Vector3d &b) {
        return std::abs(a.normalized().dot(b.normalized())) < 1e-6;
    }

    static bool is_upright_circle(const Matrix4d &world) {
        const Vector3d x = world.col(0).head<3>(), y = world.col(1).head<3>(),
                       z = world.col(2).head<3>();
        return std::abs(x.norm() - y.norm()) <= 1e-6 * x.norm() && is_orthogonal(x, y) &&
               is_orthogonal(x, z) && is_orthogonal(y, z);
    }

    static void write_cylinder(const pugi::xml_node &shape, const Matrix4d &world) {
        add_number(shape, "radius", world.col(0).norm());
        add_point(shape, "p0", Vector3d::Zero());
        add_point(shape, "p1", Vector3d(0, 0, world.col(2).norm()));
        Matrix4d rigid = world;
        rigid.topLeftCorner<3, 3>().colwise().normalize();
        add_transform(shape, rigid);
    }

    static void add_point(pugi::xml_node parent, const char *name, const Vector3d &point) {
        pugi::xml_node node = parent.append_child("point");
        node.append_attribute("name") = name;
        constexpr const char *axes[] = {"x", "y", "z"};
        for (int i = 0; i < 3; ++i) {
            node.append_attribute(axes[i]) = fmt::format("{}", point[i]).c_str();
        }
    }

    void write_light(uint32_t index) {
        using Kind = LightArrays::Kind;
        const LightArrays &lights = arrays_.lights;
        const Rgb &radiance = lights.radiance[index];
        const Matrix4d world = placed(lights.world_from_light[index]);
        const auto add = [&](const char *type) {
            return add_object(root_, "emitter", type, lights.name[index]);
        };
        switch (lights.kind[index]) {
            case Kind::diffuse_area:
                return;  // written with its shape
            case Kind::point: {
                const pugi::xml_node emitter = add("point");
                add_colour(emitter, "intensity", radiance);
                add_point(emitter, "position", world.topRightCorner<3, 1>());
                return;
            }
            case Kind::spot: {
                const pugi::xml_node emitter = add("spot");
                add_colour(emitter, "intensity", radiance);
                add_number(emitter, "beam_width", lights.inner_angle[index] / degree);
                add_number(emitter, "cutoff_angle", lights.outer_angle[index] / degree);
                add_transform(emitter, world * scaling({-1, 1, -1}));
                return;
            }
            case Kind::directional: {
                const pugi::xml_node emitter = add("directional");
                add_colour(emitter, "irradiance", radiance);
                add_transform(emitter, lights.world_from_light[index] * scaling({-1, 1, -1}));
                return;
            }
            case Kind::dome:
                require_only_surroundings(lights.name[index]);
                add_colour(add("constant"), "radiance", radiance);
                return;
            case Kind::environment:
                require_only_surroundings(lights.name[index]);
                write_environment(index, add("envmap"));
                return;
        }
    }

    void require_only_surroundings(const std::string &name) {
        if (!surroundings_.empty()) {
            throw input_error(fmt::format(
                "'{}': Mitsuba supports at most one dome or environment light, and there is "
                "already '{}'; remove one of them",
                name, surroundings_));
        }
        surroundings_ = name;
    }

    void write_environment(uint32_t index, const pugi::xml_node &emitter) {
        const LightArrays &lights = arrays_.lights;
        Rgb factor = lights.radiance[index];
        TextureImage image = *lights.image[index];
        if (factor[0] != factor[1] || factor[1] != factor[2]) {  // Mitsuba's factor is one number
            for (size_t i = 0; i < image.floats.size(); ++i) {
                image.floats[i] *= factor[static_cast<Eigen::Index>(i % 3)];
            }
            factor.setOnes();
        }
        const std::filesystem::path file = folder_.new_file(lights.name[index], ".exr");
        write_texture_file(to_mitsuba_envmap(image), file);
        add_property(emitter, "string", "filename", folder_.relative(file));
        add_property(emitter, "float", "scale", fmt::format("{}", factor[0]));
        add_transform(emitter, lights.world_from_light[index]);
    }

    const Scene &scene_;
    const SceneArrays &arrays_;
    pugi::xml_node root_;
    Names ids_;
    DataFolder folder_;
    BsdfWriter bsdfs_;
    std::string surroundings_;  ///< name of the dome or environment light
};

}  // namespace

void export_mitsuba_xml(const Scene &scene, const std::filesystem::path &path,
                        const ExportSettings &settings) {
    require_writable(path);
    pugi::xml_document document;
    SceneWriter(scene, path, document.append_child("scene")).write(settings);
    std::ostringstream text;
    document.save(text, "    ", pugi::format_indent | pugi::format_no_declaration);
    write_file(path, text.str());
}

}  // namespace rtrays
