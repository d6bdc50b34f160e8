// SPDX-License-Identifier: MIT
// Tests of experiment and gate files: the shipped ones load, and broken ones are refused with a
// message that names the error and its location.
#include "experiments/harness/kinds/curves_description.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/harness/kinds/gate.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;

const fs::path shipped = RTRAYS_EXPERIMENTS;

CurvesDescription load_curves(const fs::path &path, const std::string &profile) {
    return read_curves(load_description(path, "curves.schema.json"), profile);
}

/// Loads the text as an experiment or a gate and returns the message of the error.
std::string error_of(const std::string &text, bool as_gate = false) {
    const fs::path path = fs::path(testing::TempDir()) / "broken_experiment.json";
    write_file(path, text);
    try {
        if (as_gate) {
            read_gate(load_description(path, "gate.schema.json"));
        } else {
            load_curves(path, "quick");
        }
    } catch (const Error &error) {
        EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

std::string replaced(std::string text, const std::string &from, const std::string &to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(Description, ShippedExperimentsLoadInEveryProfile) {
    size_t count = 0;
    for (const auto &entry : fs::directory_iterator(shipped / "chapter4")) {
        const DescriptionFile file = read_description(entry.path());
        if (file.json.at("kind") != "curves") {
            continue;
        }
        ++count;
        for (const char *profile : {"quick", "full", "ci"}) {
            const auto experiment = load_curves(entry.path(), profile);
            EXPECT_EQ(experiment.name, entry.path().stem());
            // Throughput is measured on the last curve, which is path tracing in all experiments.
            EXPECT_EQ(experiment.curves.back().id(), "path_tracing.mis");
            EXPECT_TRUE(experiment.scene.is_absolute());
            for (const CurveDescription &curve : experiment.curves) {
                EXPECT_GE(curve.seeds, 8u);
                EXPECT_GE(curve.spp.size(), 3u);
            }
        }
    }
    EXPECT_GE(count, 9u);
}

TEST(Description, LaddersEndWhereTheProfileSaysForTheCurve) {
    const nlohmann::json good =
        nlohmann::json::parse(read_file(shipped / "chapter4/door_ajar.json"));
    const auto capped = [&](const std::string &most) {
        nlohmann::json experiment = good;
        experiment["profiles"]["quick"]["most_spp"] = nlohmann::json::parse("{" + most + "}");
        return experiment.dump();
    };
    const auto ladder = [&](const std::string &most) {
        const fs::path path = fs::path(testing::TempDir()) / "capped_experiment.json";
        write_file(path, capped(most));
        return load_curves(path, "quick").curves;
    };
    for (const CurveDescription &curve : ladder("\"bdpt.mis\": 8")) {
        const bool is_capped = curve.id() == "bdpt.mis";
        EXPECT_EQ(curve.spp.back(), is_capped ? 8u : 16u);
        EXPECT_EQ(curve.early_images,
                  is_capped ? std::vector<uint64_t>{4} : std::vector<uint64_t>({4, 16}));
    }
    const auto error = [&](const std::string &most) { return error_of(capped(most)); };
    EXPECT_NE(error("\"bdpt\": 8").find("unknown curve 'bdpt'"), std::string::npos);
    EXPECT_NE(error("\"bdpt.mis\": 5").find("value of \"spp\", got 5"), std::string::npos);
    EXPECT_NE(error("\"bdpt.mis\": 2").find("the third or a later value"), std::string::npos);
}

TEST(Description, CurvesThatTheProfileNamesHaveMoreSeeds) {
    const std::string good = read_file(shipped / "chapter4/glass_goblets.json");
    const auto with = [&](const std::string &more) {
        return replaced(good, "\"early_images\": [4, 16]", "\"more_seeds\": {" + more + "}");
    };
    const fs::path path = fs::path(testing::TempDir()) / "more_seeds_experiment.json";
    write_file(path, with("\"bdpt.mis\": 24"));
    for (const CurveDescription &curve : load_curves(path, "quick").curves) {
        EXPECT_EQ(curve.seeds, curve.id() == "bdpt.mis" ? 24u : 8u);
    }
    EXPECT_NE(error_of(with("\"bdpt\": 24")).find("unknown curve 'bdpt'"), std::string::npos);
    EXPECT_NE(error_of(with("\"bdpt.mis\": 4")).find("more_seeds"), std::string::npos);
}

TEST(Description, ErrorsNameTheKey) {
    const std::string good = read_file(shipped / "chapter4/cornell_diffuse.json");
    EXPECT_NE(error_of(replaced(good, "\"claim\"", "\"clam\"")).find("clam"), std::string::npos);
    EXPECT_NE(error_of(replaced(good, "\"title\"", "\"name\"")).find("duplicate key 'name'"),
              std::string::npos);
    EXPECT_NE(error_of(replaced(good, "\"seeds\": 8", "\"seeds\": 3")).find("seeds"),
              std::string::npos);
    EXPECT_NE(error_of(replaced(good, "[1, 2, 4, 8,", "[1, 4, 2, 8,")).find("must increase"),
              std::string::npos);
    EXPECT_NE(error_of(replaced(good, "\"integrator.strategies\": \"mis\"",
                                "\"integrator.strategies\": \"miss\""))
                  .find("implicit, explicit, mis"),
              std::string::npos);
    EXPECT_NE(error_of(replaced(good, "\"mis\"", "\"implicit\"")).find("two curves"),
              std::string::npos);
    EXPECT_NE(error_of("{").find("broken_experiment.json:1"), std::string::npos);
}

TEST(Description, OtherRenderersAreCurves) {
    const nlohmann::json good =
        nlohmann::json::parse(read_file(shipped / "chapter4/cornell_diffuse.json"));
    const auto with = [&](const std::string &curve) {
        nlohmann::json experiment = good;
        experiment["curves"].insert(experiment["curves"].begin(), nlohmann::json::parse(curve));
        return experiment.dump();
    };
    const auto id = [&](const std::string &curve) {
        const fs::path path = fs::path(testing::TempDir()) / "other_experiment.json";
        write_file(path, with(curve));
        return load_curves(path, "quick").curves.front().id();
    };
    EXPECT_EQ(id(R"({"engine": "mitsuba"})"), "mitsuba.llvm_ad_rgb,roulette_start=5");
    EXPECT_EQ(id(R"({"engine": "mitsuba", "variant": "scalar_rgb", "roulette_start": 1})"),
              "mitsuba.scalar_rgb,roulette_start=1");
    EXPECT_EQ(id(R"({"engine": "cycles", "label": "Cycles"})"), "cycles");
    EXPECT_EQ(id(R"({"engine": "command", "label": "My 2nd", "command": ["render"]})"),
              "command.my_2nd");
    for (const auto &[curve, text] : std::map<std::string, std::string>{
             {R"({"label": "nothing"})", "/curves/0: expected an \"algorithm\""},
             {R"({"engine": "tungsten"})", "engine"},
             {R"({"engine": "cycles", "algorithm": "path_tracing"})", "has none"},
             {R"({"engine": "cycles", "variant": "fast"})", "need \"engine\": \"mitsuba\""},
             {R"({"engine": "command", "label": "mine"})", "expected \"command\""},
             {R"({"engine": "cycles", "command": ["render"]})", "expected \"command\""},
             {R"({"engine": "command", "command": ["render"]})", "\"label\""}}) {
        EXPECT_NE(error_of(with(curve)).find(text), std::string::npos)
            << curve << ": " << error_of(with(curve));
    }
    nlohmann::json alone = good;
    alone["curves"] = nlohmann::json::parse(R"([{"engine": "cycles"}])");
    EXPECT_NE(error_of(alone.dump()).find("quick/throughput: the throughput is that of this"),
              std::string::npos)
        << error_of(alone.dump());
}

TEST(Description, UnknownProfileListsTheProfiles) {
    try {
        load_curves(shipped / "chapter4/cornell_diffuse.json", "fast");
        FAIL();
    } catch (const Error &error) {
        EXPECT_NE(std::string(error.what()).find("ci, full, quick"), std::string::npos);
    }
}

TEST(Description, ErrorsOfGatesNameTheKey) {
    const std::string good = read_file(shipped / "gates/gate_cornell_box.json");
    EXPECT_NE(error_of(replaced(good, "\"split\": 3", "\"split\": 8"), true)
                  .find("/bitwise/split: 8 must be less than"),
              std::string::npos);
    EXPECT_NE(error_of(replaced(good, "[2, 8, 32]", "[2, 32, 8]"), true)
                  .find("/convergence/spp: values must increase"),
              std::string::npos);
    EXPECT_NE(error_of(replaced(good, "\"explicit\"", "\"implicit\""), true).find("two curves"),
              std::string::npos);
}

TEST(Description, ChecksOfAGateAreOptional) {
    nlohmann::json gate = nlohmann::json::parse(read_file(shipped / "gates/gate_cornell_box.json"));
    for (const char *key : {"bitwise", "convergence", "baseline"}) {
        gate.erase(key);
    }
    EXPECT_NE(error_of(gate.dump(), true).find("need \"convergence\""), std::string::npos)
        << "an error that the slope finds";
    gate["agreement"].erase("planted_errors");
    EXPECT_EQ(error_of(gate.dump(), true), "no error");
    gate.erase("agreement");
    EXPECT_NE(error_of(gate.dump(), true).find("nothing to check"), std::string::npos);
}

TEST(Description, ErrorsOfAFileAreReportedTogether) {
    nlohmann::json experiment =
        nlohmann::json::parse(read_file(shipped / "chapter4/cornell_diffuse.json"));
    experiment["profiles"]["quick"]["seed"] = 8;
    experiment["reference"]["engine"] = "embre";
    experiment["curves"][0]["labels"] = experiment["curves"][0]["name"] = "path tracing";
    const std::string message = error_of(experiment.dump(2));
    for (const char *text :
         {"/profiles/quick", "unknown key 'seed'", "/reference/engine", "embree, mitsuba, cycles",
          "unknown key 'labels'", "unknown key 'name'"}) {
        EXPECT_NE(message.find(text), std::string::npos) << text << " in\n" << message;
    }
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 3);
}

TEST(Description, ShippedClaimsFitTheirSchema) {
    EXPECT_FALSE(load_description(shipped / "claims.json", "claims.schema.json")
                     .json.at("sections")
                     .empty());
}

TEST(Description, ShippedGateLoads) {
    const auto gate =
        read_gate(load_description(shipped / "gates/gate_cornell_box.json", "gate.schema.json"));
    EXPECT_EQ(gate.width, 64);
    EXPECT_GE(gate.convergence->renders, 16);
    EXPECT_EQ(gate.agreement->planted_errors.size(), 10u);
}

}  // namespace
}  // namespace rtrays
