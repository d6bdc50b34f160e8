// SPDX-License-Identifier: MIT
#include "cluster/agreement.h"

#include <fmt/format.h>

#include <cstdio>

#include "renderer/base/json.h"

namespace rtrays::cluster {

namespace {

/// What a rank says about itself before the render.
struct Introduction {
    std::string host;
    Preparation preparation;

    std::string to_text() const {
        Json identity = Json::array();
        for (const auto &[name, value] : preparation.identity) {
            identity.push_back({name, value});
        }
        return Json{{"host", host},
                    {"ended", preparation.ended.has_value()},
                    {"code", static_cast<int>(preparation.ended.value_or(ExitCode::ok))},
                    {"error", preparation.error},
                    {"identity", identity}}
            .dump();
    }
    static Introduction of(const std::string &text) {
        const Json json = parse_json(text, "introduction of a rank");
        Introduction introduction{json.at("host"), {{}, json.at("error"), {}}};
        if (json.at("ended")) {
            introduction.preparation.ended = static_cast<ExitCode>(json.at("code").get<int>());
        }
        for (const Json &pair : json.at("identity")) {
            introduction.preparation.identity.emplace_back(pair.at(0), pair.at(1));
        }
        return introduction;
    }
};

/// Returns how a rank differs from rank 0, which renders, or nothing.
std::optional<std::string> find_difference(const Introduction &root, const Introduction &other,
                                           size_t rank) {
    const auto &expected = root.preparation.identity, &found = other.preparation.identity;
    if (other.preparation.ended || expected.size() != found.size()) {
        return fmt::format("rank {} ({}) runs another command", rank, other.host);
    }
    for (size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] != found[i]) {
            return fmt::format("rank {} ({}) has {} {}, rank 0 ({}) has {}", rank, other.host,
                               found[i].first, found[i].second, root.host, expected[i].second);
        }
    }
    return std::nullopt;
}

struct Verdict {
    std::optional<ExitCode> ended;
    std::string message;
};

/// Adds a line, but not more than a screen of them.
void add_line(std::string &text, size_t &lines, const std::string &line) {
    constexpr size_t most = 20;
    if (++lines <= most) {
        text += (text.empty() ? "" : "\n") + line;
    } else if (lines == most + 1) {
        text += "\n...";
    }
}

Verdict judge(const std::vector<Introduction> &ranks) {
    Verdict verdict;
    size_t lines = 0;
    for (size_t rank = 0; rank < ranks.size(); ++rank) {
        const Preparation &preparation = ranks[rank].preparation;
        if (!preparation.error.empty() &&
            (rank == 0 || preparation.error != ranks[0].preparation.error)) {
            verdict.ended = verdict.ended ? verdict.ended : preparation.ended;
            add_line(verdict.message, lines,
                     rank == 0 ? preparation.error
                               : fmt::format("rank {} ({}): {}", rank, ranks[rank].host,
                                             preparation.error));
        }
    }
    if (verdict.ended || (!ranks.empty() && ranks[0].preparation.ended)) {
        return verdict.ended ? verdict : Verdict{ranks[0].preparation.ended, ""};
    }
    for (size_t rank = 1; rank < ranks.size(); ++rank) {
        if (const auto difference = find_difference(ranks[0], ranks[rank], rank)) {
            verdict.ended = ExitCode::bad_input;
            add_line(verdict.message, lines, *difference);
        }
    }
    return verdict;
}

}  // namespace

Preparation prepare_in_turn(const World &world, const std::function<Preparation()> &prepare) {
    const auto attempt = [&]() -> Preparation {
        try {
            return prepare();
        } catch (const Error &error) {
            return {error.exit_code(), error.what(), {}};
        }
    };
    Preparation preparation;
    for (const bool first : {true, false}) {
        if (first == (world.local_rank() == 0)) {
            preparation = attempt();
        }
        world.wait_for_node();
    }
    return preparation;
}

std::optional<ExitCode> agree(const World &world, const Preparation &preparation) {
    std::vector<Introduction> ranks;
    for (const std::string &text :
         world.gather(Introduction{world.host(), preparation}.to_text())) {
        ranks.push_back(Introduction::of(text));
    }
    std::string decision;
    if (world.is_root()) {
        const Verdict verdict = judge(ranks);
        if (!verdict.message.empty()) {
            fmt::print(stderr, "rtrays-mpi: {}\n", verdict.message);
        }
        decision = verdict.ended ? std::to_string(static_cast<int>(*verdict.ended)) : "";
    }
    decision = world.broadcast(decision);
    return decision.empty() ? std::nullopt
                            : std::optional(static_cast<ExitCode>(std::stoi(decision)));
}

}  // namespace rtrays::cluster
