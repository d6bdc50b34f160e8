// SPDX-License-Identifier: MIT
#include "renderer/import/models/wavefront.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/mtl.h"
#include "renderer/import/models/obj.h"
#include "renderer/import/models/ply.h"
#include "renderer/import/models/scene.h"
#include "renderer/import/models/statements.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

/// The materials of a scene that come from MTL files. A material is converted when it is first
/// used.
class MtlLibrary {
  public:
    /// If `vertex_coloured`, the colours of vertices multiply those of materials.
    MtlLibrary(fs::path model_folder, bool vertex_coloured, Scene &scene, ModelNotes &notes)
        : model_folder_(std::move(model_folder)),
          vertex_coloured_(vertex_coloured),
          scene_(scene),
          notes_(notes),
          textures_(notes) {}

    /// Adds the materials of an MTL file, unless they have been added before. The first material of
    /// a name is used.
    void add(const fs::path &file) {
        if (!added_.insert(file).second) {
            return;
        }
        for (MtlMaterial &material : read_mtl(file, notes_)) {
            if (!by_name_.emplace(material.name, materials_.size()).second) {
                repeated_.insert(material.name);
            }
            materials_.push_back(std::move(material));
            made_.emplace_back();
        }
    }

    size_t size() const { return materials_.size(); }

    const std::shared_ptr<MaterialCore> &at(size_t index) {
        std::shared_ptr<MaterialCore> &made = made_.at(index);
        if (made == nullptr) {
            const MtlMaterial &material = materials_[index];
            made = make_mtl_material(material, names_.unique(material.name, "material"),
                                     model_folder_, vertex_coloured_, textures_, notes_);
            scene_.graph().share("materials." + made->name(), made);
        }
        return made;
    }

    /// Returns the material of that name. An unknown one is grey, with a note.
    const std::shared_ptr<MaterialCore> &named(const std::string &name) {
        const auto found = by_name_.find(name);
        if (found != by_name_.end()) {
            if (repeated_.erase(name) > 0) {
                notes_.add("only the first of several materials of a name is used", name);
            }
            return at(found->second);
        }
        if (!name.empty() && undefined_.insert(name).second) {
            notes_.add(vertex_coloured_
                           ? "materials without a definition have the colours of vertices"
                           : "materials without a definition are grey",
                       name);
        }
        if (default_ == nullptr) {
            default_ =
                default_model_material(names_.unique("default", "default"),
                                       vertex_coloured_ ? textures_.vertex_colours() : nullptr);
            scene_.graph().share("materials." + default_->name(), default_);
        }
        return default_;
    }

    /// Registers the textures of the materials that were converted.
    void share_textures() {
        for (const std::shared_ptr<Texture> &texture : textures_.all()) {
            scene_.graph().share("textures." + texture->name(), texture);
        }
    }

  private:
    fs::path model_folder_;
    bool vertex_coloured_;
    Scene &scene_;
    ModelNotes &notes_;
    ModelTextures textures_;
    ModelNames names_;
    std::set<fs::path> added_;
    std::vector<MtlMaterial> materials_;
    std::vector<std::shared_ptr<MaterialCore>> made_;
    std::map<std::string, size_t> by_name_;
    std::set<std::string> repeated_;   ///< names of several materials, until they are reported
    std::set<std::string> undefined_;  ///< names that were reported
    std::shared_ptr<MaterialCore> default_;
};

/// Adds the MTL files of a statement. It names one file, whose name may have blanks, or several.
void add_libraries(const ObjLibraries &statement, const fs::path &obj, MtlLibrary &library,
                   ModelNotes &notes) {
    const std::vector<fs::path> folders = {obj.parent_path()};
    const fs::path single = find_model_file(statement.files, folders, notes);
    if (!statement.files.empty() && is_file(single)) {
        library.add(single);
        return;
    }
    std::string_view rest = statement.files;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
        const fs::path file = find_model_file(std::string(word), folders, notes);
        if (!is_file(file)) {
            throw input_error(
                fmt::format("{}:{}: missing MTL file '{}'; remove the statement to "
                            "read the model without materials",
                            obj.string(), statement.line, shown(word)));
        }
        library.add(file);
    }
}

void add_mesh(Node &node, const std::string &name, MeshCore::Geometry geometry,
              const std::shared_ptr<MaterialCore> &material, ModelNotes &notes) {
    if (needs_coordinates(*material) && geometry.uvs.empty()) {
        notes.add("textured meshes without texture coordinates show one texel", name);
    }
    const auto mesh = std::make_shared<MeshCore>(name, std::move(geometry));
    note_opposed(*mesh, notes);
    node.set_core(mesh);
    node.set_core(material);
}

}  // namespace

void read_obj_scene(const fs::path &path, Scene &scene, ModelNames &names, ModelNotes &notes,
                    bool quiet) {
    ObjFile file = read_obj(path, notes, quiet);
    const bool vertex_coloured =
        std::any_of(file.meshes.begin(), file.meshes.end(),
                    [](const ObjMesh &mesh) { return !mesh.geometry.colours.empty(); });
    MtlLibrary library(path.parent_path(), vertex_coloured, scene, notes);
    for (const ObjLibraries &statement : file.libraries) {
        add_libraries(statement, path, library, notes);
    }
    std::map<std::string, size_t> parts;  // number of meshes of each object
    for (const ObjMesh &mesh : file.meshes) {
        parts[mesh.object] += mesh.geometry.triangles.empty() ? 0 : 1;
    }
    Node &model = add_model_node(scene.graph().root(), names.unique(path.stem().string(), "model"),
                                 Eigen::Matrix4d::Identity());
    std::map<std::string, Node *> objects;
    for (ObjMesh &mesh : file.meshes) {
        if (mesh.geometry.triangles.empty()) {
            continue;
        }
        Node *&object = objects[mesh.object];
        if (object == nullptr) {
            object = &add_model_node(model, names.unique(mesh.object, "object"),
                                     Eigen::Matrix4d::Identity());
        }
        // A node has one geometry, so several materials get a child node each.
        Node &holder = parts[mesh.object] == 1
                           ? *object
                           : add_model_node(*object, names.unique(object->name(), "mesh"),
                                            Eigen::Matrix4d::Identity());
        add_mesh(holder, holder.name(), std::move(mesh.geometry), library.named(mesh.material),
                 notes);
    }
    library.share_textures();
}

MeshCore::Geometry read_obj_geometry(const fs::path &path, ModelNotes &notes, bool quiet) {
    MeshCore::Geometry geometry;
    for (ObjMesh &mesh : read_obj(path, notes, quiet).meshes) {
        append_geometry(geometry, std::move(mesh.geometry), Eigen::Matrix4d::Identity());
    }
    return geometry;
}

std::vector<std::shared_ptr<MaterialCore>> read_model_materials(const fs::path &path, Scene &scene,
                                                                ModelNotes &notes) {
    MtlLibrary library(path.parent_path(), false, scene, notes);
    library.add(path);
    std::vector<std::shared_ptr<MaterialCore>> materials;
    for (size_t i = 0; i < library.size(); ++i) {
        materials.push_back(library.at(i));
    }
    library.share_textures();
    return materials;
}

void read_ply_scene(const fs::path &path, Scene &scene, ModelNames &names, ModelNotes &notes,
                    bool quiet) {
    PlyFile file = read_ply(path, notes, quiet);
    const std::string stem = path.stem().string();
    const fs::path mtl = fs::path(path).replace_extension(".mtl");
    Node &model = add_model_node(scene.graph().root(), names.unique(stem, "model"),
                                 Eigen::Matrix4d::Identity());
    MtlLibrary library(path.parent_path(), !file.geometry.colours.empty(), scene, notes);
    if (file.material.empty() || !is_file(mtl)) {
        if (!file.material.empty()) {
            notes.add(fmt::format("{} is missing, so material_index is ignored; everything is {}",
                                  mtl.filename().string(),
                                  file.geometry.colours.empty() ? "grey" : "of vertex colours"));
        }
        add_mesh(model, stem, std::move(file.geometry), library.named(""), notes);
        library.share_textures();
        return;
    }
    library.add(mtl);
    for (auto &[index, geometry] : split_geometry(file.geometry, file.material)) {
        if (static_cast<size_t>(index) >= library.size()) {
            throw input_error(
                fmt::format("{}: material_index {} is out of range; {} has only {} materials",
                            path.string(), index, mtl.filename().string(), library.size()));
        }
        const std::shared_ptr<MaterialCore> &material = library.at(static_cast<size_t>(index));
        const std::string name = names.unique(material->name(), "mesh");
        Node &node = add_model_node(model, name, Eigen::Matrix4d::Identity());
        add_mesh(node, name, std::move(geometry), material, notes);
    }
    library.share_textures();
}

}  // namespace rtrays
