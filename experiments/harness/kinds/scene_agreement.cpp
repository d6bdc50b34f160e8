// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/scene_agreement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/array_file.h"
#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/core/resumption.h"
#include "experiments/harness/kinds/planted_error.h"
#include "reference/film.h"
#include "reference/renderer.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

// Seeds of the generators of the two renderers. They need not differ.
constexpr uint32_t renderer_seed = 21;  // of the first algorithm; the next ones use 22, 23, ...
constexpr uint64_t reference_seed = 22;

struct Description {
    std::string name;
    std::string profile;
    std::vector<fs::path> paths;  ///< scene files
    int size = 0;                 ///< pixels along a side
    uint64_t spp = 0;
    uint64_t reference_spp = 0;
    std::vector<std::string> algorithms = {"path_tracing"};
    std::string features = "scene";
    std::map<fs::path, std::vector<PlantedError>> planted_errors;  ///< by scene file
    AgreementPolicy policy;
};

constexpr uint64_t batches = 32;  ///< for each renderer, see `render_batches`

/// Reads the planted errors by scene file. Throws `Error` (bad input) if one cannot be planted, or
/// if the profile does not have its scene.
std::map<fs::path, std::vector<PlantedError>> read_planted_errors(
    const DescriptionFile &file, const std::vector<fs::path> &scenes) {
    std::map<fs::path, std::vector<PlantedError>> errors;
    for (const Json &json : file.json.value("planted_errors", Json::array())) {
        const std::string scene = json.at("scene");
        const fs::path path = file.resolve(file.json.at("folder")) / (scene + ".json");
        if (std::find(scenes.begin(), scenes.end(), path) == scenes.end()) {
            throw input_error(fmt::format("{}: the profile does not have the scene '{}'",
                                          file.location("/planted_errors"), scene));
        }
        errors[path].push_back(read_planted_error(json));
    }
    for (const auto &[path, planted] : errors) {
        require_plantable(planted);
    }
    return errors;
}

Description read(const DescriptionFile &file, const std::string &profile) {
    Description description;
    description.profile = profile;
    file.json.at("name").get_to(description.name);
    const Json &chosen = file.profile(profile);
    description.paths = file.scenes(chosen);
    chosen.at("size").get_to(description.size);
    chosen.at("spp").get_to(description.spp);
    chosen.at("reference_spp").get_to(description.reference_spp);
    description.algorithms = file.json.value("algorithms", description.algorithms);
    description.features = chosen.value("features", description.features);
    description.planted_errors = read_planted_errors(file, description.paths);
    // Bonferroni over all rows: each algorithm against the reference, and each pair of algorithms.
    const size_t algorithms = description.algorithms.size();
    description.policy.alpha /= static_cast<double>(
        description.paths.size() * (algorithms + algorithms * (algorithms - 1) / 2));
    return description;
}

/// Returns alpha^2 of the narrowest glossy lobe of all materials (the product of both axes if
/// anisotropic), or infinity if there is none.
double narrowest_lobe(const MaterialArrays &materials) {
    using Kind = BxdfComponent::Kind;
    double narrowest = std::numeric_limits<double>::infinity();
    for (const BxdfComponent &component : materials.component) {
        switch (component.kind) {
            case Kind::lambert:
            case Kind::oren_nayar:
            case Kind::coated_lambert:
            case Kind::disney_diffuse:
            case Kind::disney_sheen:
            case Kind::ideal_reflection:
            case Kind::ideal_refraction:
                break;
            case Kind::blinn:  // Walter et al. 2007, section 5.2
                narrowest = std::min(narrowest, 2 / (component.exponent + 2));
                break;
            case Kind::ward:
            case Kind::ward_original:
            case Kind::microfacet_reflection:
            case Kind::microfacet_refraction:
            case Kind::disney_clearcoat:
                narrowest = std::min(narrowest, component.alpha.prod());
        }
    }
    return narrowest;
}

/// Light of a scene that an algorithm cannot see.
struct BlindSpot {
    std::string name;  ///< description, empty if the algorithm sees all light
    /// The light that the algorithm sees, so that the reference can be restricted to it.
    std::optional<JoinableLight> joinable;
    bool judged = true;  ///< whether the sample counts suffice to test the rest
};

BlindSpot blind_spot(const std::string &algorithm, const Scene &scene,
                     const Description &description) {
    if (algorithm != "light_tracing") {
        return {};
    }
    // Light tracing connects its last vertex to the camera. Light from infinity starts on the
    // scene's bounding sphere.
    const SceneArrays &arrays = scene.arrays();
    std::vector<std::string> names;
    const auto &components = arrays.materials.component;
    if (std::any_of(components.begin(), components.end(), [](const BxdfComponent &component) {
            return component.kind == BxdfComponent::Kind::ideal_reflection ||
                   component.kind == BxdfComponent::Kind::ideal_refraction;
        })) {
        names.emplace_back("mirrors and smooth glass");
    }
    const auto &lights = arrays.lights.kind;
    const bool seen_at_infinity =
        std::any_of(lights.begin(), lights.end(), [](LightArrays::Kind kind) {
            return kind == LightArrays::Kind::dome || kind == LightArrays::Kind::environment;
        });
    if (seen_at_infinity) {
        names.emplace_back("infinitely distant light");
    }
    BlindSpot spot;
    const auto &shapes = arrays.shapes.kind;
    const bool parallel =
        seen_at_infinity ||
        std::find(lights.begin(), lights.end(), LightArrays::Kind::directional) != lights.end();
    JoinableLight joinable;
    if (parallel &&
        std::find(shapes.begin(), shapes.end(), ShapeArrays::Kind::plane) != shapes.end()) {
        names.emplace_back("planes beyond the scene's bounding sphere");
        const LightingRecord lighting = compile_scene(scene, {}).lighting;
        joinable.centre = Eigen::Map<const Eigen::Vector3f>(lighting.scene_centre).cast<double>();
        joinable.radius = static_cast<double>(lighting.scene_radius);
    }
    if (!names.empty()) {
        spot.joinable = joinable;
    }
    // A connected path is not sampled from the lobe of its vertex. About alpha^2 / 2 of the paths
    // that reach a block are in the lobe (the share of the half vectors), and each is weighted by
    // the inverse. With fewer than 30 such paths, a t test cannot estimate the scatter.
    const double paths =
        static_cast<double>(description.spp) * std::pow(description.policy.block_size, 2);
    if (paths * narrowest_lobe(arrays.materials) / 2 < 30) {
        names.emplace_back("nearly specular lobes, too few paths");
        spot.judged = false;
    }
    spot.name = fmt::format("{}", fmt::join(names, "; "));
    return spot;
}

const char *verdict_of(const Agreement &agreement, const BlindSpot &blind) {
    if (!blind.judged) {
        return "not judged";
    }
    if (!agreement.agrees()) {
        return "disagrees";
    }
    return agreement.tests > agreement.undecided ? "agrees" : "undecided";
}

/// Returns whether a row fails. A row against the reference must agree. A row of two algorithms may
/// be undecided. A planted error must be found.
bool fails(const Json &row) {
    const auto verdict = row.at("verdict").get<std::string>();
    return verdict == "disagrees" || verdict == "missed" ||
           (verdict == "undecided" && row.at("against").get<std::string>() == "reference");
}

/// Renders the image in batches.
std::vector<Image> render(const Scene &scene, const Description &description,
                          RenderSettings settings, uint32_t seed, DeviceContext &device) {
    settings.width = settings.height = description.size;
    settings.seed = seed;
    apply_setting(settings, "device.features=" + description.features);
    RenderSession session(scene, settings, device);
    return render_batches(session, seed, description.spp, batches);
}

std::vector<Image> render_reference(const Scene &scene, const Description &description,
                                    const std::optional<JoinableLight> &joinable_only) {
    ReferenceSettings settings;
    settings.joinable_only = joinable_only;
    settings.width = settings.height = description.size;
    settings.camera = static_cast<size_t>(scene.active_camera());
    settings.seed = reference_seed;
    ReferenceRenderer reference(scene.arrays(), settings);
    std::vector<Image> images;
    for (uint64_t batch = 0; batch < batches; ++batch) {
        reference.restore(reference::Film(description.size, description.size), 0);
        render_whole(reference, batch * description.reference_spp / batches,
                     (batch + 1) * description.reference_spp / batches);
        images.push_back(reference.develop());
    }
    return images;
}

/// Returns a row of the document, without its verdict.
Json row_of(const Scene &scene, const std::string &algorithm, const std::string &against,
            const BlindSpot &blind, const Agreement &agreement) {
    return {{"scene", scene.name()},
            {"algorithm", algorithm},
            {"against", against},
            {"blind", blind.name},
            {"rejected", agreement.rejected},
            {"tests", agreement.tests},
            {"undecided", agreement.undecided},
            {"largest_z", agreement.largest_z},
            {"relative_difference", to_json(agreement.relative_difference)},
            {"equivalence", to_string(agreement.equivalence)}};
}

/// Renders with a planted error and returns its row, which passes if the error is found.
Json measure_planted_error(const Scene &scene, const Description &description,
                           const PlantedError &error, const std::vector<Image> &whole,
                           DeviceContext &device) {
    const std::string algorithm = error.settings.algorithm->name;
    const BlindSpot blind = blind_spot(algorithm, scene, description);
    const std::vector<Image> reference =
        blind.joinable ? render_reference(scene, description, blind.joinable) : whole;
    const std::vector<Image> images =
        render(scene, description, planted_settings(error), renderer_seed, device);
    const Agreement agreement = test_agreement(images, reference, description.policy);
    Json row = row_of(scene, algorithm, "reference", blind, agreement);
    row["planted_error"] = error.name;
    row["verdict"] = agreement.agrees() ? "missed" : "found";
    return row;
}

/// Renders and tests a scene with every algorithm and returns the rows. Stores the images in
/// `folder` as the arrays NAME.ALGORITHM.npy, NAME.reference.npy and NAME.reference.ALGORITHM.npy.
/// The last one is the reference restricted to the light that the algorithm sees.
Json measure_scene(const Scene &scene, const Description &description,
                   const std::vector<PlantedError> &planted_errors, DeviceContext &device,
                   const fs::path &folder) {
    const std::vector<Image> whole = render_reference(scene, description, {});
    write_array(average_images(whole), folder / (scene.name() + ".reference.npy"));
    Json rows = Json::array();
    const auto add_row = [&](const std::string &algorithm, const std::string &against,
                             const BlindSpot &blind, const Agreement &agreement) {
        Json row = row_of(scene, algorithm, against, blind, agreement);
        row["verdict"] = verdict_of(agreement, blind);
        rows.push_back(row);
    };
    std::map<std::string, std::vector<Image>> seeing;  // by algorithm, of those that see all light
    uint32_t seed = renderer_seed;
    for (const std::string &algorithm : description.algorithms) {
        RenderSettings settings;
        settings.algorithm = &algorithm_named(algorithm);
        const std::vector<Image> images = render(scene, description, settings, seed++, device);
        write_array(average_images(images),
                    folder / fmt::format("{}.{}.npy", scene.name(), algorithm));
        const BlindSpot blind = blind_spot(algorithm, scene, description);
        const std::vector<Image> reference =
            blind.joinable ? render_reference(scene, description, blind.joinable) : whole;
        if (blind.joinable) {
            write_array(average_images(reference),
                        folder / fmt::format("{}.reference.{}.npy", scene.name(), algorithm));
        }
        add_row(algorithm, "reference", blind,
                test_agreement(images, reference, description.policy));
        if (blind.name.empty()) {
            for (const auto &[other, its_images] : seeing) {
                add_row(algorithm, other, blind,
                        test_agreement(images, its_images, description.policy));
            }
            seeing[algorithm] = images;
        }
    }
    for (const PlantedError &error : planted_errors) {
        rows.push_back(measure_planted_error(scene, description, error, whole, device));
    }
    return rows;
}

/// Returns the name of what was rendered: the algorithm, and the error that is planted in it.
std::string rendered(const Json &row) {
    const std::string algorithm = row.at("algorithm").get<std::string>();
    return row.contains("planted_error") ? fmt::format("{} with the planted error '{}'", algorithm,
                                                       row.at("planted_error").get<std::string>())
                                         : algorithm;
}

std::string line_of(const Json &row) {
    const Json &difference = row.at("relative_difference");
    const std::string blind = row.at("blind").get<std::string>();
    return fmt::format(
        "{}{}: {} against {}: {}, {} of {} tests reject, {} undecided, largest |z| {:.1f}, mean "
        "{:+.3f} % [{:+.3f}, {:+.3f}]{}\n",
        fails(row) ? "FAIL " : "ok   ", row.at("scene").get<std::string>(), rendered(row),
        row.at("against").get<std::string>(), row.at("verdict").get<std::string>(),
        row.at("rejected").get<size_t>(), row.at("tests").get<size_t>(),
        row.at("undecided").get<size_t>(), row.at("largest_z").get<double>(),
        100 * difference.at("value").get<double>(), 100 * difference.at("low").get<double>(),
        100 * difference.at("high").get<double>(), blind.empty() ? "" : "; not seen: " + blind);
}

std::string table_of(const Json &document) {
    const Json &experiment = document.at("experiment");
    std::string table = fmt::format(
        "Comparison of the renderer with the Embree reference, and of its algorithms with each "
        "other: {0} x {0} pixels, {1} spp, {2} spp for the reference. Blocks of 16 x 16 pixels and "
        "the full image are tested for each channel. The level is {3:.2g} over all rows, with "
        "Holm's correction; the variances come from {4} batches. A block is undecided if its "
        "batches are too skewed for a t test, and a row is undecided if most of its blocks are. "
        "The last columns are the difference of the mean with its 99 % interval, in %, and the "
        "light that the algorithm cannot see. The reference then excludes this light, too. "
        "\"Nearly specular lobes\": a connected path is not sampled from the lobe of its vertex, "
        "and fewer than 30 of the paths that reach a block are in the narrowest lobe. Such rows "
        "are not judged. A planted error must be found: its image must disagree.\n\n"
        "| scene | algorithm | against | verdict | tests | undecided | rejected | largest z | "
        "difference | from | to | not seen |\n"
        "| --- | --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n",
        experiment.at("size").get<int>(), experiment.at("spp").get<uint64_t>(),
        experiment.at("reference_spp").get<uint64_t>(), AgreementPolicy().alpha, batches);
    for (const Json &row : document.at("rows")) {
        const Json &difference = row.at("relative_difference");
        table += fmt::format(
            "| {} | {} | {} | {} | {} | {} | {} | {:.2f} | {:+.3f} | {:+.3f} | {:+.3f} | {} |\n",
            row.at("scene").get<std::string>(), rendered(row), row.at("against").get<std::string>(),
            row.at("verdict").get<std::string>(), row.at("tests").get<size_t>(),
            row.at("undecided").get<size_t>(), row.at("rejected").get<size_t>(),
            row.at("largest_z").get<double>(), 100 * difference.at("value").get<double>(),
            100 * difference.at("low").get<double>(), 100 * difference.at("high").get<double>(),
            row.at("blind").get<std::string>());
    }
    return table;
}

class SceneAgreement : public Experiment {
  public:
    SceneAgreement(const DescriptionFile &file, const RunOptions &options)
        : description_(read(file, options.profile)), inputs_(file.of_profile(options.profile)) {
        for (const fs::path &path : description_.paths) {
            scenes_.push_back(load_scene(path.string()));
        }
    }

    std::string plan() const override {
        size_t planted = 0;
        for (const auto &[path, errors] : description_.planted_errors) {
            planted += errors.size();
        }
        return fmt::format(
            "{}, profile {}: {} scenes with {}, {} spp, {} spp for the reference, {} planted "
            "errors\n",
            description_.name, description_.profile, scenes_.size(),
            fmt::join(description_.algorithms, ", "), description_.spp, description_.reference_spp,
            planted);
    }

    std::string inputs() const override {
        std::string inputs = inputs_;
        for (const Scene &scene : scenes_) {
            inputs += scene.name() + scene.hash();
        }
        return inputs;
    }

    Json measure(const Bench &bench) const override {
        fs::create_directories(bench.out / "images");
        Json document = {{"experiment",
                          {{"name", description_.name},
                           {"profile", description_.profile},
                           {"size", description_.size},
                           {"spp", description_.spp},
                           {"reference_spp", description_.reference_spp},
                           {"features", description_.features}}},
                         {"rows", Json::array()}};
        Progress progress(description_.name, scenes_.size(), "scenes", bench.quiet);
        size_t finished = 0;
        for (size_t i = 0; i < scenes_.size(); ++i) {
            const Scene &scene = scenes_[i];
            const auto planted = description_.planted_errors.find(description_.paths[i]);
            const auto rows_of_scene = [&] {
                return measure_scene(scene, description_,
                                     planted == description_.planted_errors.end()
                                         ? std::vector<PlantedError>()
                                         : planted->second,
                                     bench.device, bench.out / "images");
            };
            for (const Json &row :
                 finished_part(bench.parts / (scene.name() + ".json"), rows_of_scene)) {
                fmt::print("{}", line_of(row));
                document["rows"].push_back(row);
            }
            std::fflush(stdout);
            progress.update(++finished);
        }
        write_file(bench.out / "agreement.md", table_of(document));
        return document;
    }

    bool is_whole(const Json & /*document*/, const fs::path &out) const override {
        return std::all_of(scenes_.begin(), scenes_.end(), [&](const Scene &scene) {
            return fs::exists(out / "images" / (scene.name() + ".reference.npy"));
        });
    }

    std::optional<bool> passes(const Json &row) const override { return !fails(row); }

  private:
    Description description_;
    std::string inputs_;
    std::vector<Scene> scenes_;
};

}  // namespace

std::unique_ptr<Experiment> make_agreement(const DescriptionFile &file, const RunOptions &options) {
    return std::make_unique<SceneAgreement>(file, options);
}

}  // namespace rtrays
