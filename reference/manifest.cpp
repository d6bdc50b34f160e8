// SPDX-License-Identifier: MIT
#include "reference/manifest.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <regex>

#include "embedded/reference_schemas.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays::reference {

namespace fs = std::filesystem;

namespace {

void validate(const Json &manifest, const fs::path &path) {
    validate_json(manifest, std::string(embedded::reference_schemas().text("manifest.schema.json")),
                  path.string());
}

/// Holds an advisory lock on a folder. Two programs may finish at the same time, and each must see
/// the other's entry.
class FolderLock {
  public:
    explicit FolderLock(const fs::path &folder)
        : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        if (descriptor_ < 0 || flock(descriptor_, LOCK_EX) != 0) {
            throw run_error(
                fmt::format("cannot lock {}: {}", folder.string(), std::strerror(errno)));
        }
    }
    ~FolderLock() { close(descriptor_); }
    FolderLock(const FolderLock &) = delete;
    FolderLock &operator=(const FolderLock &) = delete;

  private:
    int descriptor_;
};

}  // namespace

ReferenceName parse_reference_name(const fs::path &path) {
    static const std::regex form(R"(([A-Za-z0-9_-]+)\.(embree|mitsuba|cycles)\.([ab])\.exr)");
    std::smatch match;
    const std::string name = path.filename().string();
    if (!std::regex_match(name, match, form)) {
        throw input_error(fmt::format(
            "{}: invalid name of a reference; expected SCENE.ENGINE.HALF.exr, where ENGINE is "
            "embree, mitsuba or cycles and HALF is a or b",
            path.string()));
    }
    return {match[1], match[2], match[3]};
}

std::string sha256_of(const fs::path &path) {
    const std::string bytes = read_file(path);
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
    unsigned int size = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
        throw run_error(fmt::format("{}: libcrypto cannot compute the SHA-256", path.string()));
    }
    std::string hexadecimal;
    for (unsigned int i = 0; i < size; ++i) {
        hexadecimal += fmt::format("{:02x}", digest[i]);
    }
    return hexadecimal;
}

Json load_manifest(const fs::path &path) {
    Json manifest = load_json(path);
    validate(manifest, path);
    return manifest;
}

void update_manifest(const fs::path &path, const fs::path &image, Json entry) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const FolderLock lock(folder);
    entry["engine"] = parse_reference_name(image).engine;
    entry["sha256"] = sha256_of(image);
    Json manifest = fs::exists(path) ? load_manifest(path)
                                     : Json{{"schema_version", 1}, {"references", Json::object()}};
    manifest["references"][image.filename().string()] = std::move(entry);
    validate(manifest, path);
    write_file(path, manifest.dump(2) + "\n");
}

Json manifest_entry(const fs::path &path, const fs::path &image) {
    if (!fs::exists(path) || !fs::exists(image)) {
        return nullptr;
    }
    const Json references = load_manifest(path).at("references");
    const auto entry = references.find(image.filename().string());
    return entry != references.end() && entry->at("sha256") == sha256_of(image) ? *entry : Json();
}

bool manifest_lists(const fs::path &path, const fs::path &image, const Json &wanted) {
    const Json entry = manifest_entry(path, image);
    if (entry.is_null() || entry.at("spp") < wanted.at("spp")) {
        return false;
    }
    for (const auto &[key, value] : wanted.items()) {
        if (key != "spp" && entry.value(key, Json()) != value) {
            return false;
        }
    }
    return true;
}

}  // namespace rtrays::reference
