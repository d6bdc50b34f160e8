// SPDX-License-Identifier: MIT
#include "renderer/import/models/textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/files.h"
#include "renderer/base/lower_case.h"
#include "renderer/import/models/statements.h"
#include "renderer/scene/cores/material.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

/// Returns `folder / path` with the case of letters of the files that exist, or an empty path.
fs::path find_in_any_case(const fs::path &folder, const fs::path &path) {
    fs::path found = folder;
    std::error_code error;
    for (const fs::path &part : path) {
        if (fs::exists(found / part, error)) {
            found /= part;
            continue;
        }
        std::vector<fs::path> same;
        for (const auto &entry : fs::directory_iterator(found.empty() ? "." : found, error)) {
            if (in_lower_case(entry.path().filename().string()) == in_lower_case(part.string())) {
                same.push_back(entry.path().filename());
            }
        }
        if (same.size() != 1) {
            return {};
        }
        found /= same[0];
    }
    return found;
}

}  // namespace

fs::path find_model_file(const std::string &stated, const std::vector<fs::path> &folders,
                         ModelNotes &notes) {
    std::string with_slashes = stated;
    std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
    const fs::path path = with_slashes;
    for (const fs::path &folder : folders) {
        for (const fs::path &tried : {path, path.filename()}) {
            if (is_file(folder / tried)) {
                return folder / tried;
            }
        }
    }
    for (const fs::path &folder : folders) {
        for (const fs::path &tried : {path.relative_path(), path.filename()}) {
            const fs::path found = find_in_any_case(folder, tried);
            if (is_file(found)) {
                notes.add("names of files differ in case from the files used",
                          fmt::format("{} is {}", stated, found.filename().string()));
                return found;
            }
        }
    }
    return folders.at(0) / path;
}

bool needs_coordinates(const MaterialCore &material) {
    const ParameterTextures &textures = material.parameters().textures();
    return std::any_of(textures.begin(), textures.end(),
                       [](const auto &named) { return named.second->image() != white_image(); });
}

Eigen::Vector3d mean_of(const TextureImage &image) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto texels = static_cast<Eigen::Index>(image.width) * image.height;
    for (Eigen::Index i = 0; i < 3 * texels; ++i) {
        sum[i % 3] += decoded_channel(image, static_cast<size_t>(i));
    }
    return sum / static_cast<double>(texels);
}

std::shared_ptr<const TextureImage> ModelTextures::load(const std::string &stated,
                                                        const std::vector<fs::path> &folders,
                                                        bool is_colour) {
    const TextureEncoding encoding =
        is_colour && !holds_floats(stated) ? TextureEncoding::srgb : TextureEncoding::linear;
    return files_.load(find_model_file(stated, folders, notes_), encoding);
}

std::shared_ptr<const TextureImage> unless_opaque(std::shared_ptr<const TextureImage> alpha) {
    const auto all = [](const auto &values, auto one) {
        return std::all_of(values.begin(), values.end(), [&](auto value) { return value == one; });
    };
    const bool is_opaque = all(alpha->bytes, uint8_t{255}) && all(alpha->floats, 1.0f);
    return is_opaque ? nullptr : alpha;
}

std::shared_ptr<const TextureImage> ModelTextures::load_alpha(
    const std::string &stated, const std::vector<fs::path> &folders) {
    const fs::path path = find_model_file(stated, folders, notes_);
    return has_alpha_channel(path) ? unless_opaque(files_.load(path, TextureEncoding::alpha))
                                   : nullptr;
}

std::shared_ptr<Texture> ModelTextures::texture(const std::shared_ptr<const TextureImage> &image,
                                                const std::string &file,
                                                const TexturePlacement &placement) {
    const Eigen::Vector2d &scale = placement.scale;
    const Eigen::Vector2d &offset = placement.offset;
    const std::string key =
        fmt::format("{} {} {} {} {} {} {} {}", static_cast<const void *>(image.get()),
                    static_cast<int>(placement.wrap), placement.is_nearest,
                    placement.vertex_colours, scale[0], scale[1], offset[0], offset[1]);
    std::shared_ptr<Texture> &made = textures_[key];
    if (made == nullptr) {
        std::string path = file;
        std::replace(path.begin(), path.end(), '\\', '/');
        made = std::make_shared<Texture>(
            names_.unique(fs::path(path).stem().string(), "texture"), image,
            ParameterValues{{"filter", std::string(placement.is_nearest ? "nearest" : "bilinear")},
                            {"wrap", wrap_names()[static_cast<size_t>(placement.wrap)]},
                            {"uv_scale", scale},
                            {"uv_offset", offset},
                            {"vertex_colours", placement.vertex_colours}});
        all_.push_back(made);
    }
    return made;
}

std::shared_ptr<Texture> ModelTextures::vertex_colours() {
    TexturePlacement placement;
    placement.is_nearest = true;
    placement.vertex_colours = true;
    return texture(white_image(), "vertex_colours", placement);
}

}  // namespace rtrays
