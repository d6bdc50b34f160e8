// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/mitsuba_xml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "renderer/base/notice.h"
#include "renderer/import/mitsuba/bsdf.h"
#include "renderer/import/mitsuba/light.h"
#include "renderer/import/mitsuba/shape.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

using namespace mitsuba;

/// What makes a shape emit: a light, or a texture, which becomes the emission of its material.
struct ShapeEmission {
    std::shared_ptr<LightCore> light;
    std::shared_ptr<Texture> texture;
};

class SceneReader {
  public:
    SceneReader(const Document &document, const std::string &source_name, Scene &scene)
        : document_(document),
          source_name_(source_name),
          scene_(scene),
          materials_(document, scene) {}

    void read() {
        for (const Element &element : document_.elements()) {
            errors_.collect([&] { read_element(element); });
        }
        errors_.collect([&] { check_hidden_emitters(); });
        errors_.raise(source_name_);
        tell();
    }

    void finish(bool is_part) {
        try {
            scene_.update(0);
            scene_.recentre();
        } catch (const Error &error) {
            throw input_error(fmt::format("{}: {}", source_name_, error.what()));
        }
        if (cameras_.empty()) {
            if (is_part) {
                return;
            }
            throw input_error(fmt::format("{}: the scene has no sensor; add one", source_name_));
        }
        scene_.set_active_camera(cameras_.front());
        if (cameras_.size() > 1) {
            notice(fmt::format("{}: the file has several sensors ({}); only the first one is used",
                               source_name_, fmt::join(cameras_, ", ")));
        }
    }

  private:
    struct Handler {
        const char *tag;
        void (SceneReader::*read)(const Element &);
    };
    static const Handler handlers[8];

    /// Returns the id of an element, or its tag if it has none.
    static std::string wanted_name(const Element &element) {
        const std::string id = element.attribute("id");
        return id.empty() ? element.tag() : id;
    }

    Node &add_node(const Element &element, const std::string &name,
                   const Eigen::Matrix4d &world_from_object) {
        Node &node = scene_.graph().root().add_child(std::make_unique<Node>(name));
        element.located(
            [&] { node.set_core(std::make_shared<TransformCore>(name, world_from_object)); });
        node.set_core(std::make_shared<VisibilityCore>(name, true));
        return node;
    }

    void read_element(const Element &element) {
        const std::string tag = element.tag();
        const auto found = std::find_if(std::begin(handlers), std::end(handlers),
                                        [&](const Handler &handler) { return tag == handler.tag; });
        if (found == std::end(handlers)) {
            throw element.error("unsupported element");
        }
        (this->*found->read)(element);
    }

    /// Sends the notices about what was replaced or left out.
    void tell() const {
        if (!replaced_.empty()) {
            notice(fmt::format("{}: replaced by this renderer's own settings: {}", source_name_,
                               fmt::join(replaced_, ", ")));
        }
        if (!invisible_.empty()) {
            notice(
                fmt::format("{}: shapes with BSDF null do not interact with light and are left "
                            "out: {}",
                            source_name_, fmt::join(invisible_, ", ")));
        }
        for (const auto &[hash, element] : area_lights_) {
            if (attached_.count(hash) == 0) {
                notice(element.error("no shape refers to this emitter, so it is left out").what());
            }
        }
    }

    /// Throws if hide_emitters would change the image.
    void check_hidden_emitters() const {
        if (hides_emitters_ && (has_surroundings_ || !attached_.empty())) {
            throw hides_emitters_->error(
                "unsupported: emitters cannot be hidden from the camera here; set it to false");
        }
    }

    /// Ignores an element that is read where another element refers to it.
    void pass(const Element &) {}

    void read_shape(const Element &element) {
        const std::string type = element.attribute("type");
        if (type == "instance") {
            read_instance(element);
        } else if (type != "shapegroup") {  // read where an instance refers to it
            read_shape_in(element, Eigen::Matrix4d::Identity(), false);
        }
    }

    /// Adds copies of the shapes of a group.
    void read_instance(const Element &element) {
        Object instance(element, document_);
        const std::vector<Element> groups = instance.objects("shape");
        const Eigen::Matrix4d to_world = instance.transform();
        instance.finish();
        if (groups.size() != 1 || groups[0].attribute("type") != "shapegroup") {
            throw element.error("needs a reference to one shapegroup");
        }
        Object group(groups[0], document_);
        const std::vector<Element> shapes = group.objects("shape");
        group.finish();
        for (const Element &shape : shapes) {
            errors_.collect([&] { read_shape_in(shape, to_world, true); });
        }
    }

    /// Reads a shape, whose coordinates `parent` transforms to the world.
    void read_shape_in(const Element &element, const Eigen::Matrix4d &parent, bool is_instanced) {
        Object object(element, document_);
        const std::optional<Shape> shape = errors_.collect([&] { return shapes_.read(object); });
        const std::vector<Element> emitters = object.objects("emitter");
        const std::vector<Element> bsdfs = object.objects("bsdf");
        if (shape) {
            object.finish();
        }
        if (emitters.size() > 1 || bsdfs.size() > 1) {
            throw element.error("a shape takes at most one emitter and one BSDF");
        }
        if (is_instanced && !emitters.empty()) {
            throw emitters[0].error("unsupported in a shapegroup; Mitsuba has no such emitters");
        }
        if (!bsdfs.empty() && bsdfs[0].attribute("type") == "null") {
            read_null(element, bsdfs[0], !emitters.empty());
            return;
        }
        // Errors of the emitter and the BSDF are reported even if there is no geometry.
        const auto name = node_names_.unique(wanted_name(element));
        const UvConvention uv = shape ? shape->uv : UvConvention::same;
        const auto emission = errors_.collect([&] { return read_shape_light(emitters, uv); });
        const auto texture = emission ? emission->texture : nullptr;
        const auto material = errors_.collect([&] {
            return !bsdfs.empty()       ? materials_.read(bsdfs[0], uv, name, texture)
                   : texture != nullptr ? materials_.emitting(texture)
                                        : materials_.standard(!emitters.empty());
        });
        if (shape && material && emission) {
            Shape placed = *shape;
            placed.world_from_geometry = parent * placed.world_from_geometry;
            add_shape(element, name, placed, *material, *emission);
        }
    }

    void add_shape(const Element &element, const std::string &name, const Shape &shape,
                   const std::shared_ptr<MaterialCore> &material, const ShapeEmission &emission) {
        check_vertex_colours(element, shape, *material);
        const bool emits = emission.light != nullptr || emission.texture != nullptr;
        const bool is_flipped = shape.is_flipped && !looks_the_same_flipped(*material, emits);
        const bool is_mapped = material->normal_map_texture() != nullptr &&
                               dynamic_cast<const MeshCore *>(shape.geometry.get()) == nullptr;
        const bool needs_mesh = is_flipped || is_mapped || (emits && !shape.can_emit);
        const Shape placed = needs_mesh ? tessellated(shape) : shape;
        if (needs_mesh) {
            notice(element
                       .error(fmt::format(
                           "replaced by a mesh of {} triangles, because this shape cannot {} here",
                           static_cast<const MeshCore &>(*placed.geometry).triangles().size(),
                           is_flipped  ? "be flipped"
                           : is_mapped ? "have a normal or bump map"
                                       : "emit"))
                       .what());
        }
        Node &node = add_node(element, name, placed.world_from_geometry);
        node.set_core(placed.geometry);
        node.set_core(material);
        if (emission.light != nullptr) {
            node.set_core(emission.light);
        }
    }

    /// Throws if a texture needs colours of vertices that the shape lacks.
    static void check_vertex_colours(const Element &element, const Shape &shape,
                                     const MaterialCore &material) {
        const auto *const mesh = dynamic_cast<const MeshCore *>(shape.geometry.get());
        if (mesh != nullptr && !mesh->colours().empty()) {
            return;
        }
        for (const auto &[parameter, texture] : material.parameters().textures()) {
            if (texture->has_vertex_colours()) {
                throw element.error(fmt::format(
                    "has no vertex_color, which texture '{}' of its BSDF shows; use a PLY file "
                    "with red, green and blue of vertices",
                    texture->name()));
            }
        }
    }

    /// Returns the emission of a shape whose texture coordinates follow `uv`.
    ShapeEmission read_shape_light(const std::vector<Element> &emitters, UvConvention uv) {
        if (emitters.empty()) {
            return {};
        }
        attached_.insert(emitters[0].hash());
        Object emitter(emitters[0], document_);
        const std::vector<Element> textures = emitter.objects("texture", "radiance");
        if (textures.empty()) {
            return {read_area_light(emitter), nullptr};
        }
        check_area_light(emitter);
        emitter.ignore("sampling_weight");  // affects noise only
        if (textures.size() > 1 || emitter.has("radiance")) {
            throw emitters[0].error("duplicate property 'radiance'");
        }
        emitter.finish();
        return {nullptr, materials_.texture(textures[0], uv)};
    }

    /// Leaves out a shape that light passes through.
    void read_null(const Element &shape, const Element &bsdf, bool emits) {
        Object(bsdf, document_).finish();
        if (emits) {
            throw bsdf.error("unsupported on a shape with an emitter");
        }
        invisible_.push_back(wanted_name(shape));
    }

    /// Returns whether both sides of a surface scatter light equally, and none emits.
    static bool looks_the_same_flipped(const MaterialCore &material, bool emits) {
        const std::vector<MaterialComponent> components = material.components();
        const bool refracts =
            std::any_of(components.begin(), components.end(), [](const MaterialComponent &part) {
                return part.bxdf.kind == BxdfComponent::Kind::ideal_refraction ||
                       part.bxdf.kind == BxdfComponent::Kind::microfacet_refraction;
            });
        return !emits && !refracts && material.two_sided();
    }

    void read_emitter(const Element &element) {
        Object object(element, document_);
        if (object.type() == "area") {  // read with the shape that refers to it
            area_lights_.emplace(element.hash(), element);
            return;
        }
        has_surroundings_ |= object.type() == "constant" || object.type() == "envmap";
        const PlacedLight placed = read_light(object, materials_.files());
        add_node(element, node_names_.unique(wanted_name(element)), placed.world_from_light)
            .set_core(placed.light);
    }

    void read_sensor(const Element &element) {
        Object object(element, document_);
        const PlacedCamera placed = read_camera(object, document_);
        Node &node =
            add_node(element, node_names_.unique(wanted_name(element)), placed.world_from_camera);
        node.set_core(placed.camera);
        if (cameras_.empty()) {
            scene_.set_film_size(placed.width, placed.height);
            if (placed.crop) {
                element.located([&] { scene_.set_crop(*placed.crop); });
            }
            replaced_.insert(replaced_.end(), placed.replaced.begin(), placed.replaced.end());
        }
        cameras_.push_back(node.name());
    }

    void read_integrator(const Element &element) {
        std::vector<std::string> settings;
        for (const Element &child : element.children()) {
            if (child.tag() == "integrator") {
                read_integrator(child);
            } else if (child.property_name() == "hide_emitters" && is_true(child)) {
                hides_emitters_ = child;
            }
            if (child.has("name") && child.has("value")) {
                settings.push_back(
                    fmt::format("{} {}", child.raw_attribute("name"), child.attribute("value")));
            }
            if (child.property_name() == "max_depth") {
                // Mitsuba counts path edges, this renderer counts scattering events.
                const std::vector<double> depth = parse_numbers(child, child.attribute("value"));
                if (depth.size() == 1 && depth[0] >= 2) {
                    settings.push_back(
                        fmt::format("use --set integrator.max_depth={}", depth[0] - 1));
                }
            }
        }
        // An undefined parameter in the type is no error, because the integrator is ignored.
        std::string type = element.raw_attribute("type");
        try {
            type = element.attribute("type");
        } catch (const LocatedError &) {
        }
        if (type == "direct") {
            settings.emplace_back("use --set integrator.max_depth=1");
        }
        replaced_.push_back(
            fmt::format("integrator '{}'{}", type,
                        settings.empty() ? "" : fmt::format(" ({})", fmt::join(settings, ", "))));
    }

    static bool is_true(const Element &element) {
        const std::string value = element.attribute("value");
        return value.size() == 4 && std::tolower(static_cast<unsigned char>(value[0])) == 't';
    }

    const Document &document_;
    std::string source_name_;
    Scene &scene_;
    MaterialReader materials_;
    ShapeReader shapes_;
    ErrorList errors_;
    NameList node_names_;
    std::vector<std::string> cameras_;
    std::vector<std::string> replaced_;
    std::vector<std::string> invisible_;  ///< names of shapes with BSDF null
    std::optional<Element> hides_emitters_;
    bool has_surroundings_ = false;          ///< there is a light that surrounds the scene
    std::map<size_t, Element> area_lights_;  ///< area emitters outside of shapes, by hash
    std::set<size_t> attached_;              ///< hashes of the emitters of shapes
};

const SceneReader::Handler SceneReader::handlers[8] = {
    {"shape", &SceneReader::read_shape},   {"emitter", &SceneReader::read_emitter},
    {"sensor", &SceneReader::read_sensor}, {"integrator", &SceneReader::read_integrator},
    {"bsdf", &SceneReader::pass},          {"texture", &SceneReader::pass},
    {"film", &SceneReader::pass},          {"sampler", &SceneReader::pass},
};

}  // namespace

Scene parse_mitsuba_xml(const std::string &text, const std::string &source_name,
                        const std::string &default_name, const std::filesystem::path &directory,
                        const std::map<std::string, std::string> &defines, bool is_part) {
    const Document document(text, source_name, directory, defines);
    Scene scene;
    scene.set_name(default_name);
    SceneReader reader(document, source_name, scene);
    reader.read();
    reader.finish(is_part);
    return scene;
}

}  // namespace rtrays
