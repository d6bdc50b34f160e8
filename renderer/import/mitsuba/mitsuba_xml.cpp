// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/mitsuba_xml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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

class SceneReader {
  public:
    SceneReader(const Document &document, const std::string &source_name, Scene &scene)
        : document_(document),
          source_name_(source_name),
          scene_(scene),
          materials_(document, scene) {}

    void read() {
        for (const Element &element : document_.elements()) {
            const std::string tag = element.tag();
            const auto found =
                std::find_if(std::begin(handlers), std::end(handlers),
                             [&](const Handler &handler) { return tag == handler.tag; });
            if (found == std::end(handlers)) {
                throw element.error("unsupported element");
            }
            (this->*found->read)(element);
        }
        if (!replaced_.empty()) {
            notice(fmt::format("{}: replaced by this renderer's own settings: {}", source_name_,
                               fmt::join(replaced_, ", ")));
        }
    }

    void finish() {
        try {
            scene_.update(0);
            scene_.recentre();
        } catch (const Error &error) {
            throw input_error(fmt::format("{}: {}", source_name_, error.what()));
        }
        if (cameras_.empty()) {
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

    Node &add_node(const Element &element, const Eigen::Matrix4d &world_from_object) {
        const std::string wanted = element.has("id") ? element.attribute("id") : element.tag();
        const std::string name = node_names_.unique(wanted.empty() ? element.tag() : wanted);
        Node &node = scene_.graph().root().add_child(std::make_unique<Node>(name));
        element.located(
            [&] { node.set_core(std::make_shared<TransformCore>(name, world_from_object)); });
        node.set_core(std::make_shared<VisibilityCore>(name, true));
        return node;
    }

    /// Ignores an element that is read where another element refers to it.
    void pass(const Element &) {}

    void read_shape(const Element &element) {
        Object object(element, document_);
        const Shape shape = shapes_.read(object);
        const std::vector<Element> emitters = object.objects("emitter");
        const std::vector<Element> bsdfs = object.objects("bsdf");
        object.finish();
        if (emitters.size() > 1 || bsdfs.size() > 1) {
            throw element.error("a shape takes at most one emitter and one BSDF");
        }
        Node &node = add_node(element, shape.world_from_geometry);
        const std::shared_ptr<MaterialCore> material =
            bsdfs.empty() ? materials_.standard(!emitters.empty())
                          : materials_.read(bsdfs[0], shape.uv, node.name());
        if (shape.is_flipped) {
            check_flipped(element, *material, !emitters.empty());
        }
        node.set_core(shape.geometry);
        node.set_core(material);
        if (!emitters.empty()) {
            if (!shape.can_emit) {
                throw element.error(
                    "emitters are unsupported on this shape; use a rectangle, disk, sphere, cube, "
                    "obj or ply");
            }
            Object emitter(emitters[0], document_);
            node.set_core(read_area_light(emitter));
        }
    }

    /// Throws unless the flipped shape looks the same from both sides. The front of our spheres and
    /// cylinders is always their outside.
    static void check_flipped(const Element &element, const MaterialCore &material, bool emits) {
        const std::vector<MaterialComponent> components = material.components();
        const bool refracts =
            std::any_of(components.begin(), components.end(), [](const MaterialComponent &part) {
                return part.bxdf.kind == BxdfComponent::Kind::ideal_refraction ||
                       part.bxdf.kind == BxdfComponent::Kind::microfacet_refraction;
            });
        if (emits || refracts || !material.two_sided()) {
            throw element.error(
                "flip_normals: unsupported, the front of this shape is always its outside; use a "
                "two-sided BSDF without an emitter, or a mesh");
        }
    }

    void read_emitter(const Element &element) {
        Object object(element, document_);
        const PlacedLight placed = read_light(object, materials_.files());
        add_node(element, placed.world_from_light).set_core(placed.light);
    }

    void read_sensor(const Element &element) {
        Object object(element, document_);
        const PlacedCamera placed = read_camera(object, document_);
        Node &node = add_node(element, placed.world_from_camera);
        node.set_core(placed.camera);
        if (cameras_.empty()) {
            scene_.set_film_size(placed.width, placed.height);
            replaced_.insert(replaced_.end(), placed.replaced.begin(), placed.replaced.end());
        }
        cameras_.push_back(node.name());
    }

    void read_integrator(const Element &element) {
        std::vector<std::string> settings;
        for (const Element &child : element.children()) {
            if (child.has("name") && child.has("value")) {
                settings.push_back(
                    fmt::format("{} {}", child.raw_attribute("name"), child.attribute("value")));
            }
            if (child.raw_attribute("name") == "max_depth") {
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
        replaced_.push_back(
            fmt::format("integrator '{}'{}", type,
                        settings.empty() ? "" : fmt::format(" ({})", fmt::join(settings, ", "))));
    }

    const Document &document_;
    std::string source_name_;
    Scene &scene_;
    MaterialReader materials_;
    ShapeReader shapes_;
    NameList node_names_;
    std::vector<std::string> cameras_;
    std::vector<std::string> replaced_;
};

const SceneReader::Handler SceneReader::handlers[8] = {
    {"shape", &SceneReader::read_shape},   {"emitter", &SceneReader::read_emitter},
    {"sensor", &SceneReader::read_sensor}, {"integrator", &SceneReader::read_integrator},
    {"bsdf", &SceneReader::pass},          {"texture", &SceneReader::pass},
    {"film", &SceneReader::pass},          {"sampler", &SceneReader::pass},
};

}  // namespace

Scene parse_mitsuba_xml(const std::string &text, const std::string &source_name,
                        const std::string &default_name, const std::filesystem::path &directory) {
    const Document document(text, source_name, directory);
    Scene scene;
    scene.set_name(default_name);
    SceneReader reader(document, source_name, scene);
    reader.read();
    reader.finish();
    return scene;
}

}  // namespace rtrays
