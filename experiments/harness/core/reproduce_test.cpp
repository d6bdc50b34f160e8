// SPDX-License-Identifier: MIT
// Tests of collections: their steps, and the estimate of the time left.
#include "experiments/harness/core/reproduce.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "experiments/harness/kinds/kinds.h"
#include "renderer/base/files.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;

const fs::path shipped = RTRAYS_EXPERIMENTS;

std::vector<Step> steps_of(const fs::path &collection, const std::string &profile) {
    ReproduceOptions options;
    options.collection = collection;
    options.profile = profile;
    return collection_steps(options, experiment_kinds());
}

TEST(Collection, HasEveryExperimentOfItsFolders) {
    std::set<std::string> names;
    for (const Step &step : steps_of(shipped / "chapter4.json", "full")) {
        EXPECT_TRUE(names.insert(step.name).second) << step.name;
        EXPECT_EQ(step.options.out, fs::path("chapter4.full") / step.name);
        EXPECT_EQ(step.may_fail, step.name == "stability");
    }
    for (const char *folder : {"chapter4", "speed", "robustness"}) {
        for (const auto &entry : fs::directory_iterator(shipped / folder)) {
            EXPECT_EQ(names.count(entry.path().stem()), 1u) << entry.path();
        }
    }
}

TEST(Collection, ProfilesMayDifferAndLeaveOut) {
    const std::vector<Step> steps = steps_of(shipped / "chapter4.json", "quick");
    for (const Step &step : steps) {
        EXPECT_NE(step.name, "stiffness");
        EXPECT_EQ(step.options.profile, step.name == "stability" ? "ci" : "quick") << step.name;
    }
    EXPECT_GE(steps.size(), 20u);
}

TEST(Collection, EmptyAndMissingFoldersAreErrors) {
    const fs::path folder = fs::path(testing::TempDir()) / "collection";
    fs::create_directories(folder / "empty");
    const auto error_of = [&](const std::string &name) -> std::string {
        const fs::path path = folder / "collection.json";
        write_file(path,
                   R"({"name": "some", "title": "Some", "profiles": {"quick": {}}, "folders": [")" +
                       name + "\"]}");
        try {
            steps_of(path, "quick");
        } catch (const Error &error) {
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
            return error.what();
        }
        return "no error";
    };
    EXPECT_NE(error_of("empty").find("empty: no experiments"), std::string::npos);
    EXPECT_NE(error_of("missing").find("missing: No such file"), std::string::npos);
}

TEST(RecordedSeconds, AreThoseOfTheContext) {
    const fs::path path = fs::path(testing::TempDir()) / "recorded.json";
    write_file(path, R"({"experiment": {"profile": "full"},
                         "context": {"started_at": "2026-02-28T23:59:30Z",
                                     "finished_at": "2026-03-01T00:01:00Z"}})");
    EXPECT_EQ(recorded_seconds(path), 90);
    EXPECT_EQ(recorded_seconds(path, "full"), 90);
    EXPECT_EQ(recorded_seconds(path, "quick"), std::nullopt);
    write_file(path, R"({"rows": []})");
    EXPECT_EQ(recorded_seconds(path), std::nullopt);
    EXPECT_EQ(recorded_seconds(path.string() + ".missing"), std::nullopt);
}

TEST(TimeLeftTest, ScalesRecordedTimesByThoseMeasured) {
    TimeLeft left({100, 300, std::nullopt}, false);  // the third counts as 200
    EXPECT_EQ(left.seconds(), std::nullopt);
    left.finish(10);
    EXPECT_EQ(left.seconds(), 50);
    left.finish(90);  // 100 s measured, 400 s recorded
    EXPECT_EQ(left.seconds(), 50);
    left.finish(1);
    EXPECT_EQ(left.seconds(), 0);
}

TEST(TimeLeftTest, FinishedStepsDoNotEnterTheRatio) {
    TimeLeft left({100, 300}, true);
    EXPECT_EQ(left.seconds(), 400);
    left.finish(std::nullopt);
    EXPECT_EQ(left.seconds(), 300);
}

}  // namespace
}  // namespace rtrays
