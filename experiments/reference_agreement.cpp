// SPDX-License-Identifier: MIT
// The references of other renderers, Embree's and our own image against each other, pair by pair.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/agreement.h"
#include "experiments/document.h"
#include "experiments/hierarchy/kinds.h"
#include "experiments/ladder.h"
#include "experiments/references.h"
#include "renderer/base/error.h"
#include "renderer/pipeline/render_session.h"
#include "renderer/scene/scene.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;

constexpr const char *engines[] = {"embree", "mitsuba", "cycles"};

struct Contender {
    Json description;  ///< {"engine", "spp", "noise_rmse"}
    Image image;
};

Contender rendered(const Scene &scene, const MeasurementSettings &wanted, uint32_t seed, DeviceContext &device) {
    RenderSettings settings;
    settings.seed = seed;
    settings.width = wanted.width;
    settings.height = wanted.height;
    RenderSession session(scene, settings, device);
    render_whole(session, 0, wanted.spp);
    Contender contender{{{"name", "renderer"}, {"engine", "RTRays, path tracing (MIS)"}, {"spp", wanted.spp}}, session.develop()};
    double variance = 0;
    for (const std::string &name : rgb_names("variance")) {
        for (const float value : contender.image.channel(name)) {
            variance += static_cast<double>(value);
        }
    }
    contender.description["noise_rmse"] = std::sqrt(variance / (3.0 * wanted.width * wanted.height));
    return contender;
}

const fs::path root = RTRAYS_SOURCE;

/// All pairs of a scene, and which references it has none of.
Json row_of_scene(const std::string &name, const MeasurementSettings &wanted, uint32_t seed, DeviceContext &device) {
    const fs::path path = root / "scenes" / name / "scene.json";
    const Scene scene = load_scene(path.string());
    std::vector<Contender> contenders;
    Json absent = Json::array();
    for (const char *engine : engines) {
        try {
            StoredReference stored = load_reference({references_manifest().parent_path(), scene.name(), scene.hash(), engine,
                                                     wanted.width, wanted.height, path.string()});
            contenders.push_back({{{"name", engine},
                                   {"engine", stored.description.at("engine")},
                                   {"spp", stored.description.at("spp")},
                                   {"noise_rmse", stored.description.at("noise_floor").at("rmse")}},
                                  std::move(stored.reference.image)});
        } catch (const Error &error) {
            if (error.exit_code() != ExitCode::reference_missing) {
                throw;
            }
            absent.push_back(engine);
        }
    }
    contenders.push_back(rendered(scene, wanted, seed, device));

    const AgreementPolicy policy;
    Json described = Json::array(), pairs = Json::array();
    for (size_t i = 0; i < contenders.size(); ++i) {
        described.push_back(contenders[i].description);
        for (size_t j = 0; j < i; ++j) {
            pairs.push_back({{"image", contenders[i].description.at("name")},
                             {"against", contenders[j].description.at("name")},
                             {"agreement", to_json(test_agreement(contenders[i].image, contenders[j].image, policy), policy)}});
        }
    }
    return {{"scene", name}, {"renderers", described}, {"absent", absent}, {"pairs", pairs}};
}

}  // namespace

fs::path references_manifest() {
    return root / "results/references/manifest.json";
}

MeasurementPlan plan_reference_agreement(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    uint32_t seed = 0;  // another of each: the boxes would be lit by the same paths
    for (const std::string &name : settings.references) {
        ++seed;
        plan.tasks.push_back({name, [=, &device] { return row_of_scene(name, settings, seed, device); }});
    }
    plan.summarise = [](const Json &) { return Json::object(); };
    return plan;
}

}  // namespace rtrays
