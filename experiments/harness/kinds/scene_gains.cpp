// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/scene_gains.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/harness/kinds/unreferenced.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

std::unique_ptr<Experiment> make_scene_gains(const DescriptionFile &file,
                                             const RunOptions &options) {
    const std::filesystem::path folder = file.resolve(file.json.at("folder"));
    std::vector<UnreferencedCase> cases;
    std::string plan;
    for (const std::filesystem::path &path : file.scenes(file.profile(options.profile))) {
        const std::string name = path.lexically_relative(folder).replace_extension().string();
        std::string part = name + ".json";
        std::replace(part.begin(), part.end(), '/', '.');
        cases.push_back({part, {{"scene", name}}, [path] {
                             Scene scene = load_scene(path.string());
                             scene.update(0);
                             return scene;
                         }});
        plan += "  " + name + "\n";
    }
    return make_unreferenced(file, options.profile, {"name", "title", "thesis", "claim"},
                             std::move(cases), plan);
}

}  // namespace rtrays
