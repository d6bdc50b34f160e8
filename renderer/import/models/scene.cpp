// SPDX-License-Identifier: MIT
// Conversion of Assimp nodes, meshes, lights and cameras, with corrections for Assimp 5.2.5.
#include "renderer/import/models/scene.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include "renderer/base/angles.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/lower_case.h"
#include "renderer/import/models/assimp.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/gltf.h"
#include "renderer/import/models/material.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

Vector3d vector(const aiVector3D &v) {
    return {v.x, v.y, v.z};
}
Vector3d vector(const aiColor3D &c) {
    return {c.r, c.g, c.b};
}

Matrix4d matrix(const aiMatrix4x4 &m) {
    Matrix4d result;
    result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
        m.d3, m.d4;
    return result;
}

/// An Assimp scene and the conventions of its file format.
struct ModelSource {
    std::shared_ptr<const aiScene> scene;
    std::filesystem::path path;
    std::vector<GltfMaterial> gltf_materials{};  ///< of a glTF file, in its order
    std::vector<std::string> gltf_nodes{};  ///< names of the nodes of a glTF file, in its order
    bool states_outer_cone = false;         ///< a Collada file with such an extension
    double metres = 1;                      ///< unit of lengths of an FBX file

    bool is(const char *extension) const { return lower_extension(path) == extension; }
    bool is_gltf() const { return is(".gltf") || is(".glb"); }
    /// STL has no materials, and its normals repeat those of the triangles.
    bool is_stl() const { return is(".stl"); }
    bool is_fbx() const { return is(".fbx"); }
    bool is_collada() const { return is(".dae") || is(".zae"); }
    /// Factor from the cone angles of a file to half angles. glTF measures the cones of spot lights
    /// from the axis, all other formats from side to side.
    double half_angle() const { return is_gltf() ? 1 : 0.5; }
    /// Returns the angles of a spot light within which it is bright, and beyond which it is dark.
    /// For Collada, Assimp 5.2.5 adds 84 degrees to the cone of `falloff_angle`, unless the file
    /// states the outer cone by an extension.
    std::pair<double, double> cone(const aiLight &light) const {
        const auto inner = static_cast<double>(light.mAngleInnerCone);
        const auto outer = static_cast<double>(light.mAngleOuterCone);
        return {inner, is_collada() && !states_outer_cone ? inner : outer};
    }
    /// Returns the name in the file of a node, or of the light or camera of a node.
    std::string name(const aiString &name) const {
        const std::string stated = name.C_Str();
        size_t index = gltf_nodes.size();  // the name of a glTF node is its index
        std::from_chars(stated.data(), stated.data() + stated.size(), index);
        return index < gltf_nodes.size() ? gltf_nodes[index] : stated;
    }
    /// Returns the position of a camera in its node. Assimp 5.2.5 adds the translation of the node
    /// to a glTF camera, although the node already applies it.
    Vector3d position(const aiCamera &camera) const {
        return is_gltf() ? Vector3d(Vector3d::Zero()) : vector(camera.mPosition);
    }
    /// Returns the angle of view along x in radians, or 0 if it is unknown. Two errors of Assimp
    /// 5.2.5 are corrected. It multiplies the angle along y of glTF by the aspect ratio, which is
    /// not an angle of view. It loses the angle of Collada cameras without a name and returns
    /// 45 degrees, converted to radians twice.
    double fov(const aiCamera &camera) const {
        const double stated = static_cast<double>(camera.mHorizontalFOV);
        const double aspect = camera.mAspect > 0 ? static_cast<double>(camera.mAspect) : 1;
        if (is_gltf()) {
            return 2 * std::atan(std::tan(0.5 * stated / aspect) * aspect);
        }
        const double lost = pi / 4 * pi / 180;
        return is(".dae") && camera.mAspect == 0 && std::abs(stated - lost) < 1e-6 ? 0 : stated;
    }
};

/// Reads what Assimp loses of a glTF file. Returns the content that Assimp reads.
std::string read_gltf_details(ModelSource &source, ModelNotes &notes) {
    GltfFile file = read_gltf(source.path);
    try {
        check_gltf(file.document, source.path, notes);
        source.gltf_materials = gltf_materials(file.document, notes);
        source.gltf_nodes = gltf_node_names(file.document);
        return for_assimp(std::move(file));
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("{}: {}", source.path.string(), error.what()));
    }
}

/// Reads how a Collada file describes the cones of spot lights.
void read_collada_details(ModelSource &source, ModelNotes &notes) {
    if (!source.is(".dae")) {
        return;  // .zae is compressed
    }
    const std::string text = read_file(source.path);
    const auto states = [&](const char *element) {
        return text.find(element) != std::string::npos;
    };
    source.states_outer_cone = states("<outer_cone") || states("<penumbra_angle");
    if (states("<falloff_exponent")) {
        notes.add("falloff_exponent of spot lights is ignored");
    }
}

/// Reads the unit of lengths of an FBX file. Assimp leaves lengths in that unit.
void read_fbx_details(ModelSource &source, ModelNotes &notes) {
    double centimetres = 1;
    const aiMetadata *const data = source.scene->mMetaData;
    float stated = 0;
    if (data != nullptr && !data->Get("UnitScaleFactor", centimetres) &&
        data->Get("UnitScaleFactor", stated)) {
        centimetres = static_cast<double>(stated);
    }
    if (!(centimetres > 0)) {
        throw input_error(
            fmt::format("{}: UnitScaleFactor is {}", source.path.string(), centimetres));
    }
    source.metres = 0.01 * centimetres;
    if (source.metres != 1) {
        notes.add(
            fmt::format("lengths are converted to metres by the factor {:g}; the intensities "
                        "of lights keep their numbers",
                        source.metres));
    }
}

ModelSource open_model(const std::filesystem::path &path, ModelNotes &notes, bool quiet) {
    ModelSource source{nullptr, path};
    const std::string content = source.is_gltf() ? read_gltf_details(source, notes) : "";
    source.scene = read_by_assimp(path, content, quiet);
    if (source.scene->mRootNode == nullptr || source.scene->mNumMeshes == 0) {
        throw input_error(fmt::format("{}: the file has no geometry", path.string()));
    }
    if (source.is_collada()) {
        read_collada_details(source, notes);
    } else if (source.is_fbx()) {
        read_fbx_details(source, notes);
    }
    return source;
}

/// Returns the triangles of one mesh, or none if it consists of points and lines.
MeshCore::Geometry geometry_of(const ModelSource &source, const aiMesh &mesh,
                               const std::string &name, unsigned channel,
                               const GltfTextureTransform &uv_transform, ModelNotes &notes) {
    MeshCore::Geometry geometry;
    const bool has_normals = mesh.HasNormals() && !source.is_stl();
    const bool has_uvs = mesh.HasTextureCoords(channel);
    const bool has_colours = mesh.HasVertexColors(0) && source.is_gltf();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        geometry.vertices.push_back(vector(mesh.mVertices[i]));
        if (has_normals) {
            geometry.normals.push_back(vector(mesh.mNormals[i]));
        }
        if (has_uvs) {
            const aiVector3D &uv = mesh.mTextureCoords[channel][i];
            geometry.uvs.emplace_back(uv_transform.linear * Eigen::Vector2d(uv.x, uv.y) +
                                      uv_transform.offset);
        }
        if (has_colours) {
            const aiColor4D &c = mesh.mColors[0][i];
            geometry.colours.emplace_back(c.r, c.g, c.b);
        }
    }
    for (unsigned face = 0; face < mesh.mNumFaces; ++face) {
        add_face(mesh.mFaces[face].mIndices, mesh.mFaces[face].mNumIndices, face, name, geometry,
                 notes);
    }
    if (mesh.HasVertexColors(0) && !has_colours) {
        notes.add("vertex colours are ignored", name);
    } else if (mesh.HasVertexColors(1)) {
        notes.add("only the first of several vertex colours is used", name);
    }
    if (mesh.HasBones() || mesh.mNumAnimMeshes > 0) {
        notes.add("skeletons and morph targets are ignored; meshes keep their stored pose", name);
    }
    // Most of Assimp's readers give every corner of every face its own vertex.
    join_vertices(geometry);
    repair_normals(geometry, name, notes);
    clamp_colours(geometry, name, notes);
    return geometry;
}

const aiMesh &mesh_at(const ModelSource &source, unsigned index) {
    if (index >= source.scene->mNumMeshes ||
        source.scene->mMeshes[index]->mMaterialIndex >= source.scene->mNumMaterials) {
        throw input_error(fmt::format("{}: a mesh or a material is missing; the file is damaged",
                                      source.path.string()));
    }
    return *source.scene->mMeshes[index];
}

/// Fills a scene from a model file.
class SceneWriter {
  public:
    SceneWriter(ModelSource source, Scene &scene, ModelNames &names, ModelNotes &notes)
        : source_(std::move(source)),
          model_(*source_.scene),
          scene_(scene),
          names_(names),
          notes_(notes),
          materials_(source_.scene, source_.path.parent_path(), source_.gltf_materials,
                     source_.is_gltf(), notes),
          mesh_cores_(model_.mNumMeshes),
          material_cores_(model_.mNumMaterials) {}

    void write() {
        write_nodes();
        for (unsigned i = 0; i < model_.mNumLights; ++i) {
            write_light(*model_.mLights[i]);
        }
        for (unsigned i = 0; i < model_.mNumCameras; ++i) {
            write_camera(*model_.mCameras[i]);
        }
        for (const std::shared_ptr<Texture> &texture : materials_.textures()) {
            scene_.graph().share("textures." + texture->name(), texture);
        }
        if (model_.mNumAnimations > 0) {
            notes_.add("animations are ignored; nodes keep their stored transforms");
        }
    }

  private:
    /// Adds all nodes. Without recursion, because a chain of nodes may exceed the call stack.
    void write_nodes() {
        std::vector<std::pair<const aiNode *, Node *>> pending{
            {model_.mRootNode, &scene_.graph().root()}};
        while (!pending.empty()) {
            const auto [from, parent] = pending.back();
            pending.pop_back();
            const std::string wanted = source_.name(from->mName);
            const double unit = from == model_.mRootNode ? source_.metres : 1;
            Node *node = nullptr;
            try {
                node = &add_model_node(*parent, names_.unique(wanted, "node"),
                                       scaling({unit, unit, unit}) * matrix(from->mTransformation));
            } catch (const Error &) {
                notes_.add(
                    "nodes whose transform cannot be inverted are ignored, with their children",
                    wanted);
                continue;
            }
            nodes_.emplace(from->mName.C_Str(), node);
            for (unsigned i = 0; i < from->mNumMeshes; ++i) {
                // Our nodes have one geometry each, so several meshes get a child node each.
                Node &holder = from->mNumMeshes == 1
                                   ? *node
                                   : add_model_node(*node, names_.unique(node->name(), "mesh"),
                                                    Matrix4d::Identity());
                write_mesh(from->mMeshes[i], holder);
            }
            for (unsigned i = from->mNumChildren; i > 0; --i) {
                pending.emplace_back(from->mChildren[i - 1], node);
            }
        }
    }

    void write_mesh(unsigned index, Node &node) {
        const aiMesh &mesh = mesh_at(source_, index);
        const unsigned material = mesh.mMaterialIndex;
        const std::string name =
            mesh.mName.length > 0 ? mesh.mName.C_Str() : fmt::format("mesh {}", index);
        std::shared_ptr<MeshCore> &core = mesh_cores_[index];
        if (core == nullptr) {
            MeshCore::Geometry geometry =
                geometry_of(source_, mesh, name, materials_.uv_channel(material),
                            materials_.uv_transform(material), notes_);
            if (geometry.triangles.empty()) {
                notes_.add("meshes without triangles are ignored", name);
                return;
            }
            core = std::make_shared<MeshCore>(name, std::move(geometry));
            note_opposed(*core, notes_);
        }
        std::shared_ptr<MaterialCore> &made = material_cores_[material];
        if (made == nullptr) {
            made = source_.is_stl()
                       ? default_model_material("default")
                       : materials_.material(material, material_names_.unique(
                                                           materials_.name(material), "material"));
            scene_.graph().share("materials." + made->name(), made);
        }
        if (needs_coordinates(*made) && core->uvs().empty()) {
            notes_.add("textured meshes without texture coordinates show one texel", name);
        }
        if (made->normal_map_texture() != nullptr && mesh.HasTangentsAndBitangents()) {
            notes_.add("stored tangents are replaced by those of the texture coordinates", name);
        }
        node.set_core(core);
        node.set_core(made);
    }

    /// Returns the node of the same name as a light or a camera, or the root.
    Node &owner(const aiString &name) {
        const auto found = nodes_.find(name.C_Str());
        if (nodes_.count(name.C_Str()) > 1) {
            notes_.add("several nodes have the name of a light or camera, which is placed at one",
                       name.C_Str());
        }
        return found != nodes_.end() ? *found->second : scene_.graph().root();
    }

    /// Adds a node for a light or a camera as a child of the node of its name.
    Node &placed(const aiString &name, const char *what, const Matrix4d &transform) {
        Node &node = owner(name);
        return add_model_node(
            node, names_.unique(fmt::format("{} {}", source_.name(name), what), what), transform);
    }

    static Matrix4d pose(const Vector3d &position, const Vector3d &direction, const Vector3d &up) {
        const Vector3d other =
            std::abs(direction.normalized().y()) < 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
        const bool has_up = direction.cross(up).norm() > 1e-3 * direction.norm() * up.norm();
        return look_at(position, position + direction, has_up ? up : other);
    }

    /// Returns the intensity of a light in W/sr, or its irradiance in W/m^2.
    Vector3d intensity(const aiLight &light) {
        // Luminous efficacy in lm/W. Blender writes lights with this factor, too.
        constexpr double efficacy = 683;
        if (!source_.is_gltf()) {
            return vector(light.mColorDiffuse);
        }
        notes_.add(
            "intensities of lights are converted from candela to W/sr, and from lux to "
            "W/m^2, by the factor 1/683; emission keeps its numbers",
            source_.name(light.mName));
        return vector(light.mColorDiffuse) / efficacy;
    }

    void write_light(const aiLight &light) {
        const std::string name = source_.name(light.mName);
        const Vector3d colour = intensity(light);
        const Vector3d position = vector(light.mPosition);
        const Vector3d direction = vector(light.mDirection);
        const bool is_pointing = light.mType == aiLightSource_SPOT ||
                                 light.mType == aiLightSource_DIRECTIONAL ||
                                 light.mType == aiLightSource_AREA;
        const bool is_area = light.mType == aiLightSource_AREA;
        if ((!is_pointing && light.mType != aiLightSource_POINT) ||
            (is_pointing && !(direction.norm() > 0)) ||
            (is_area && !(light.mSize.x > 0 && light.mSize.y > 0))) {
            notes_.add("ambient lights and lights without direction or size are ignored", name);
            return;
        }
        const bool falls_off =
            light.mType == aiLightSource_POINT || light.mType == aiLightSource_SPOT;
        if (falls_off && (light.mAttenuationConstant != 0 || light.mAttenuationLinear != 0)) {
            notes_.add(
                "attenuation of lights is ignored; they fall off with the square of the distance, "
                "and their colours are in W/sr",
                name);
        }
        if (light.mType == aiLightSource_POINT) {
            Node &node = placed(light.mName, "light", translation(position));
            node.set_core(std::make_shared<LightCore>(node.name(), "point",
                                                      ParameterValues{{"intensity", colour}}));
            return;
        }
        // An area light shines along +z, the others along -z.
        Matrix4d transform =
            pose(position, is_area ? Vector3d(-direction) : direction, vector(light.mUp));
        if (is_area) {
            transform = transform * scaling({0.5 * light.mSize.x, 0.5 * light.mSize.y, 1});
        }
        Node &node = placed(light.mName, "light", transform);
        if (light.mType == aiLightSource_DIRECTIONAL) {
            node.set_core(std::make_shared<LightCore>(node.name(), "directional",
                                                      ParameterValues{{"irradiance", colour}}));
        } else if (is_area) {
            node.set_core(std::make_shared<MeshCore>(node.name(), rectangle()));
            node.set_core(std::make_shared<MaterialCore>(
                node.name(), "lambert", ParameterValues{{"reflectance", Vector3d(0, 0, 0)}}));
            node.set_core(std::make_shared<LightCore>(node.name(), "diffuse_area",
                                                      ParameterValues{{"radiance", colour}}));
        } else {
            node.set_core(std::make_shared<LightCore>(node.name(), "spot", spot(light, colour)));
        }
    }

    ParameterValues spot(const aiLight &light, const Vector3d &colour) {
        constexpr double widest = 90;
        // Maximum ratio of the inner angle to the outer one. The light falls off between the cones,
        // so that they must differ.
        constexpr double softest = 0.99;
        const double to_degrees = source_.half_angle() * 180 / pi;
        const auto [stated_inner, stated_outer] = source_.cone(light);
        double outer = to_degrees * stated_outer;
        if (outer > widest) {
            notes_.add("spot light cones are limited to 90 degrees", source_.name(light.mName));
            outer = widest;
        }
        const double inner = std::min(to_degrees * stated_inner, softest * outer);
        if (inner < softest * outer) {
            notes_.add("spot lights fall off linearly with the angle between their cones",
                       source_.name(light.mName));
        }
        return {{"intensity", colour}, {"inner_degrees", inner}, {"outer_degrees", outer}};
    }

    void write_camera(const aiCamera &camera) {
        const std::string name = source_.name(camera.mName);
        const double fov = source_.fov(camera);
        const Vector3d direction = vector(camera.mLookAt);
        const bool is_parallel = camera.mOrthographicWidth > 0;
        if ((!is_parallel && !(fov > 0 && fov < pi)) || !(direction.norm() > 0)) {
            notes_.add("cameras without direction or angle of view are ignored", name);
            return;
        }
        Node &node = placed(camera.mName, "camera",
                            pose(source_.position(camera), direction, vector(camera.mUp)));
        // Assimp states half the width of the view.
        const double width = 2 * source_.metres * static_cast<double>(camera.mOrthographicWidth);
        node.set_core(
            is_parallel
                ? std::make_shared<CameraCore>(
                      node.name(), "orthographic",
                      ParameterValues{{"size", width}, {"size_axis", std::string("x")}})
                : std::make_shared<CameraCore>(
                      node.name(), "pinhole",
                      ParameterValues{{"fov", fov * 180 / pi}, {"fov_axis", std::string("x")}}));
        if (has_camera_) {
            notes_.add("only the first camera is used; the others remain in the scene", name);
        } else if (camera.mAspect > 0) {
            const double height =
                std::round(scene_.film_width() / static_cast<double>(camera.mAspect));
            scene_.set_film_size(scene_.film_width(),
                                 static_cast<int>(std::min(std::max(height, 1.0), 4096.0)));
        }
        has_camera_ = true;
    }

    ModelSource source_;
    const aiScene &model_;
    Scene &scene_;
    ModelNames &names_;
    ModelNotes &notes_;
    ModelNames material_names_;
    ModelMaterials materials_;
    std::vector<std::shared_ptr<MeshCore>> mesh_cores_;
    std::vector<std::shared_ptr<MaterialCore>> material_cores_;
    std::unordered_multimap<std::string, Node *> nodes_;  ///< by the names that Assimp gives them
    bool has_camera_ = false;
};

/// Runs `body` and prefixes its errors with the file.
template <typename Body>
auto with_file(const std::filesystem::path &path, const Body &body) {
    try {
        return body();
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("{}: {}", path.string(), error.what()));
    }
}

}  // namespace

MeshCore::Geometry read_model_geometry(const std::filesystem::path &path, ModelNotes &notes,
                                       bool quiet) {
    const ModelSource source = open_model(path, notes, quiet);
    return with_file(path, [&] {
        MeshCore::Geometry geometry;
        std::vector<std::pair<const aiNode *, Matrix4d>> pending{
            {source.scene->mRootNode, scaling({source.metres, source.metres, source.metres})}};
        while (!pending.empty()) {
            const aiNode *const node = pending.back().first;
            const Matrix4d transform = pending.back().second * matrix(node->mTransformation);
            pending.pop_back();
            for (unsigned i = 0; i < node->mNumMeshes; ++i) {
                const aiMesh &mesh = mesh_at(source, node->mMeshes[i]);
                append_geometry(geometry,
                                geometry_of(source, mesh, mesh.mName.C_Str(), 0, {}, notes),
                                transform);
            }
            for (unsigned i = node->mNumChildren; i > 0; --i) {
                pending.emplace_back(node->mChildren[i - 1], transform);
            }
        }
        repair_normals(geometry, path.filename().string(), notes);
        return geometry;
    });
}

void read_model_scene(const std::filesystem::path &path, Scene &scene, ModelNames &names,
                      ModelNotes &notes, bool quiet) {
    ModelSource source = open_model(path, notes, quiet);
    with_file(path, [&] { SceneWriter(std::move(source), scene, names, notes).write(); });
}

}  // namespace rtrays
