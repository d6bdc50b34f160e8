// SPDX-License-Identifier: MIT
#include "reference/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <type_traits>

#include "renderer/base/error.h"
#include "renderer/base/files.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "state files are little-endian");

namespace rtrays::reference {

namespace {

constexpr char magic[] = "RTRAYREF";
constexpr size_t magic_size = 8;
constexpr uint32_t format_version = 2;
constexpr size_t hash_size = 32;
constexpr size_t prefix_size = magic_size + 2 * sizeof(uint32_t);
constexpr size_t pixel_size = sizeof(PixelSums);
static_assert(pixel_size == PixelSums::word_count * sizeof(int64_t), "sums are stored as words");
static_assert(std::is_standard_layout_v<PixelSums> && std::is_trivially_copyable_v<PixelSums>,
              "sums are stored as bytes");

void append(std::string &bytes, uint32_t value) {
    bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
}

uint32_t read_u32(const std::string &bytes, size_t offset) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

Json to_json(SampleRange range) {
    return {range.begin, range.end};
}

SampleRange range_from_json(const Json &json) {
    return {json.at(0), json.at(1)};
}

/// A key of two configurations with values that differ; null where one lacks the key.
struct Difference {
    std::string key, first, second;
};

std::optional<Difference> find_difference(const Json &first, const Json &second) {
    // A window of the picture has a key that the full picture lacks.
    Json all = first;
    all.update(second);
    for (const auto &entry : all.items()) {
        const Json a = first.value(entry.key(), Json()), b = second.value(entry.key(), Json());
        if (a != b) {
            return Difference{entry.key(), a.dump(), b.dump()};
        }
    }
    return std::nullopt;
}

Error damaged(const std::filesystem::path &path, const std::string &what) {
    return input_error(
        fmt::format("{}: {}; delete it to start again, or restore a copy", path.string(), what));
}

}  // namespace

Json make_config(const std::string &scene_name, const std::string &scene_hash,
                 const ReferenceSettings &settings, const std::string &engine) {
    Json config = {{"scene", scene_name},
                   {"scene_hash", scene_hash},
                   {"width", settings.width},
                   {"height", settings.height},
                   {"camera", settings.camera},
                   {"seed", settings.seed},
                   {"strategies", name_of(settings.strategies)},
                   {"max_depth", settings.max_depth},
                   {"engine", engine},
                   {"sampling_version", sampling_version}};
    if (settings.full_width > 0) {
        config["crop"] = {settings.crop_x, settings.crop_y, settings.full_width,
                          settings.full_height};
    }
    return config;
}

void save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &path) {
    const Film &film = checkpoint.film;
    Json ranges = Json::array();
    for (const SampleRange &range : film.ranges) {
        ranges.push_back(to_json(range));
    }
    const std::string header = Json{
        {"config", checkpoint.config},
        {"ranges", ranges},
        {"wanted", to_json(checkpoint.wanted)},
        {"seconds", checkpoint.seconds},
        {"commits",
         checkpoint.commits}}.dump();
    std::string bytes(magic, magic_size);
    append(bytes, format_version);
    append(bytes, static_cast<uint32_t>(header.size()));
    bytes += header;
    bytes.append(reinterpret_cast<const char *>(film.pixels.data()),
                 film.pixels.size() * pixel_size);
    bytes += content_hash(bytes);
    write_file(path, bytes);
}

Checkpoint load_checkpoint(const std::filesystem::path &path) {
    const std::string bytes = read_file(path);
    if (bytes.size() < prefix_size + hash_size || bytes.compare(0, magic_size, magic) != 0) {
        throw damaged(path, "not a state file of rtrays-reference");
    }
    if (const uint32_t version = read_u32(bytes, magic_size); version != format_version) {
        throw damaged(path, fmt::format("unsupported format version {}, expected {}", version,
                                        format_version));
    }
    const size_t content_size = bytes.size() - hash_size;
    if (content_hash(bytes.substr(0, content_size)) != bytes.substr(content_size)) {
        throw damaged(path, "truncated or damaged (checksum mismatch)");
    }
    // The checksum guarantees that the header's fields exist and have the right types.
    const size_t header_size = read_u32(bytes, magic_size + sizeof(uint32_t));
    const Json header = parse_json(bytes.substr(prefix_size, header_size), path.string());
    const Json &config = header.at("config");
    Film film(config.at("width"), config.at("height"));
    for (const Json &range : header.at("ranges")) {
        film.add(range_from_json(range));
    }
    const size_t pixels_size = film.pixels.size() * pixel_size;
    if (prefix_size + header_size + pixels_size != content_size) {
        throw damaged(path, "wrong number of pixels for the film size in the header");
    }
    std::memcpy(static_cast<void *>(film.pixels.data()), bytes.data() + prefix_size + header_size,
                pixels_size);
    return {config, std::move(film), range_from_json(header.at("wanted")), header.at("seconds"),
            header.at("commits")};
}

void require_continues(const Checkpoint &checkpoint, const Json &config, SampleRange wanted,
                       const std::filesystem::path &path) {
    if (const auto difference = find_difference(checkpoint.config, config)) {
        throw input_error(
            fmt::format("{}: rendered with {} = {}, this run requests {}; specify another --state, "
                        "or delete it to start again",
                        path.string(), difference->key, difference->first, difference->second));
    }
    const SampleRanges &ranges = checkpoint.film.ranges;
    if (!ranges.empty() &&
        (ranges.front().begin < wanted.begin || ranges.back().end > wanted.end)) {
        throw input_error(fmt::format(
            "{}: holds the samples {}, which the requested range {}:{} does not continue; "
            "specify another range or --state, or delete it to start again",
            path.string(), describe(ranges), wanted.begin, wanted.end));
    }
}

void merge_checkpoint(Checkpoint &checkpoint, const Checkpoint &other) {
    if (const auto difference = find_difference(checkpoint.config, other.config)) {
        throw input_error(fmt::format("films differ in {} ({} and {}) and cannot be merged",
                                      difference->key, difference->first, difference->second));
    }
    checkpoint.film.merge(other.film);
    checkpoint.wanted = {std::min(checkpoint.wanted.begin, other.wanted.begin),
                         std::max(checkpoint.wanted.end, other.wanted.end)};
    checkpoint.seconds += other.seconds;
    add_commits(checkpoint.commits, other.commits);
}

void add_commits(std::vector<std::string> &commits, const std::vector<std::string> &more) {
    for (const std::string &commit : more) {
        if (std::find(commits.begin(), commits.end(), commit) == commits.end()) {
            commits.push_back(commit);
        }
    }
}

}  // namespace rtrays::reference
