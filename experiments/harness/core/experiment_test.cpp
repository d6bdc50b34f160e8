// SPDX-License-Identifier: MIT
// Tests of the shape that all experiments share.
#include "experiments/harness/core/experiment.h"

#include <gtest/gtest.h>

#include "experiments/harness/core/document.h"
#include "experiments/harness/kinds/kinds.h"
#include "renderer/base/files.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;

TEST(VerdictLine, CountsFailedChecks) {
    EXPECT_EQ(verdict_line(13, 0), "all 13 checks passed");
    EXPECT_EQ(verdict_line(4, 9), "9 of 13 checks failed");
}

std::string error_of_file(const std::string &text) {
    const fs::path path = fs::path(testing::TempDir()) / "kind.json";
    write_file(path, text);
    try {
        load_experiment(path, experiment_kinds());
    } catch (const Error &error) {
        EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

TEST(Kind, MustBeKnown) {
    EXPECT_NE(
        error_of_file(R"({"kind": "colours"})").find("unknown kind \"colours\"; kinds are: curv"),
        std::string::npos);
    EXPECT_NE(error_of_file("[]").find("missing key 'kind'"), std::string::npos);
    EXPECT_NE(error_of_file(R"({"kind": "gate"})").find("missing key 'name'"), std::string::npos);
}

std::string error_of_document(const Json &document) {
    try {
        parse_document(document.dump(), "run.json");
    } catch (const Error &error) {
        return error.what();
    }
    return "no error";
}

Json document_of(const std::string &kind) {
    return {{"schema_version", document_version},
            {"kind", kind},
            {"experiment", {{"name", "box"}, {"profile", "ci"}}},
            {"context", {{"commit", ""}, {"dirty", false}, {"device", {{"name", ""}}}}}};
}

TEST(Document, HasTheCommonPartsAndThoseOfItsKind) {
    Json document = document_of("convergence_control");
    document["experiment"].update({{"size", 16}, {"spp", 4}, {"seeds", 8}});
    EXPECT_NE(error_of_document(document).find("missing key 'rows'"), std::string::npos);
    document.erase("context");
    EXPECT_NE(error_of_document(document).find("missing key 'context'"), std::string::npos);
    EXPECT_NE(error_of_document(document_of("colours")).find("bvh_build"), std::string::npos);
}

TEST(Document, EveryKindWithAResultHasASchema) {
    for (const Kind &kind : experiment_kinds()) {
        if (kind.has(Option::out)) {
            EXPECT_NE(error_of_document(document_of(kind.name)).find("missing key"),
                      std::string::npos)
                << kind.name;
        }
    }
}

/// The stored documents are those that this program would accept.
TEST(Document, StoredDocumentsFitTheirSchemas) {
    size_t count = 0;
    for (const auto &entry :
         fs::recursive_directory_iterator(fs::path(RTRAYS_EXPERIMENTS) / "../results")) {
        if (entry.path().filename() == document_name) {
            EXPECT_NO_THROW(parse_document(read_file(entry.path()), entry.path())) << entry.path();
            ++count;
        }
    }
    EXPECT_GT(count, 20u);
}

}  // namespace
}  // namespace rtrays
