// SPDX-License-Identifier: MIT
// Images of named float channels, and their OpenEXR files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace rtrays {

/// Value of an attribute in the EXR header.
using Attribute = std::variant<int, float, double, std::string>;

/// A float32 image, linear Rec. 709, planar. The first three channels are "R", "G", "B" (radiance,
/// W / (sr m^2)). Further layers have dotted names: "variance.R" (variance of the MEAN per pixel),
/// "samples" (sample count per pixel), ...
///
/// Rows run from the top; pixel (x, y) of a channel is at `y * width + x`.
class Image {
  public:
    struct Channel {
        std::string name;
        std::vector<float> values;  ///< width * height
    };

    Image() = default;
    Image(int width, int height) : width_(width), height_(height) {}

    /// Returns a black image with the channels R, G, B.
    static Image rgb(int width, int height);

    int width() const { return width_; }
    int height() const { return height_; }

    /// Position of pixel (0, 0) in the full picture: the corner of an EXR's data window. It is not
    /// (0, 0) for a crop of a larger picture.
    int left() const { return left_; }
    int top() const { return top_; }
    void move_to(int left, int top) {
        left_ = left;
        top_ = top;
    }
    size_t pixel_count() const {
        return static_cast<size_t>(width_) * static_cast<size_t>(height_);
    }

    const std::vector<Channel> &channels() const { return channels_; }
    bool has(const std::string &name) const { return find(name) != nullptr; }

    /// Returns the values of a channel. Throws `Error` if the image has no channel of that name.
    const std::vector<float> &channel(const std::string &name) const;
    std::vector<float> &channel(const std::string &name);

    /// Appends a channel of zeros and returns its values. Throws `Error` if the name is taken.
    std::vector<float> &add_channel(const std::string &name);

    std::map<std::string, Attribute> &attributes() { return attributes_; }
    const std::map<std::string, Attribute> &attributes() const { return attributes_; }

  private:
    const Channel *find(const std::string &name) const;

    int width_ = 0;
    int height_ = 0;
    int left_ = 0;
    int top_ = 0;
    std::vector<Channel> channels_;
    std::map<std::string, Attribute> attributes_;
};

/// Returns the names of the colour channels in order, prefixed by `layer`: "variance" gives
/// "variance.R", ...
std::vector<std::string> rgb_names(const std::string &layer = "");

/// Reads all channels of the data window, and the attributes of int, float, double and string type.
/// Throws `Error` (bad input) naming the file when it is missing, truncated or not an EXR.
Image read_exr(const std::filesystem::path &path);

/// Writes the image atomically (to a temporary file beside it, which is then renamed), as
/// ZIP-compressed float32 with the standard `chromaticities` of Rec. 709. The display window is the
/// data window. Throws `Error` (run failed) naming the file.
void write_exr(const Image &image, const std::filesystem::path &path);

/// Checks the name of an output file before the image exists. Throws `Error` (bad input) if
/// `write_exr` cannot write it or its extension is not .exr, which would misrepresent the content.
void require_exr_output(const std::filesystem::path &path);

}  // namespace rtrays
