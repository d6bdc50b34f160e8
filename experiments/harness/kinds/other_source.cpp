// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "experiments/harness/core/resumption.h"
#include "experiments/harness/kinds/curve_source.h"
#include "experiments/harness/kinds/measurements/peer.h"
#include "renderer/base/clock.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/process.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

/// An image to render.
struct Request {
    uint64_t spp;
    uint32_t seed;
    fs::path output;
};

/// A renderer that is another program.
class Program {
  public:
    virtual ~Program() = default;
    virtual std::string name() const = 0;
    /// Renders an image and returns its seconds. Throws `Error` (run failed).
    virtual double render(const Request &request) = 0;
    /// Whether another number of samples needs other kernels.
    virtual bool compiles_by_count() const = 0;
};

/// Mitsuba or Cycles, which stays loaded between the images.
class InstalledRenderer : public Program {
  public:
    InstalledRenderer(const OtherRenderer &other, const fs::path &scene_file,
                      const RenderSettings &settings, const fs::path &folder)
        : roulette_(std::max(1u, other.roulette_start)), max_depth_(settings.max_depth) {
        Scene scene = load_scene(scene_file.string());
        scene.set_film_size(settings.width, settings.height);
        const std::string kind = other.engine == "mitsuba" ? other.variant : other.engine;
        peer_.emplace(scene, folder, kind);
        if (!peer_->is_there()) {
            throw Error(ExitCode::skipped,
                        fmt::format("{} does not start; scripts/install --peers installs Mitsuba "
                                    "3 and Cycles",
                                    Peer::name_of(kind)));
        }
    }

    std::string name() const override { return peer_->engine(); }

    double render(const Request &request) override {
        return peer_->render({max_depth_, request.spp, roulette_, request.output, request.seed})
            .wall;
    }

    bool compiles_by_count() const override { return true; }

  private:
    uint32_t roulette_, max_depth_;
    std::optional<Peer> peer_;
};

/// A command that renders one image.
class Command : public Program {
  public:
    Command(const CurveDescription &curve, const fs::path &scene_file,
            const RenderSettings &settings)
        : name_(curve.label), words_(curve.other->command) {
        places_["scene"] = fs::absolute(scene_file).lexically_normal().string();
        places_["width"] = std::to_string(settings.width);
        places_["height"] = std::to_string(settings.height);
    }

    std::string name() const override { return name_; }

    double render(const Request &request) override {
        places_["output"] = request.output.string();
        places_["spp"] = std::to_string(request.spp);
        places_["seed"] = std::to_string(request.seed);
        std::vector<std::string> command;
        for (const std::string &word : words_) {
            command.push_back(filled(word));
        }
        fs::remove(request.output);  // of an interrupted run
        const auto start = SteadyClock::now();
        Process process(command);
        process.end_input();
        std::optional<double> reported;
        while (const auto line = process.read_line()) {
            const auto record = nlohmann::json::parse(*line, nullptr, false);
            if (record.is_object() && record.value("seconds", nlohmann::json()).is_number()) {
                reported = record.at("seconds").get<double>();
                if (!(*reported > 0)) {
                    throw run_error(fmt::format("'{}' reported {} seconds", name_, *reported));
                }
            }
        }
        if (const int code = process.wait(); code != 0) {
            throw run_error(fmt::format("'{}' ended with exit code {}: {}", name_, code,
                                        fmt::join(command, " ")));
        }
        if (!fs::exists(request.output)) {
            throw run_error(fmt::format("'{}' wrote no image to {{output}}: {}", name_,
                                        fmt::join(command, " ")));
        }
        return reported.value_or(seconds_since(start));
    }

    bool compiles_by_count() const override { return false; }

  private:
    /// Returns a word of the command with the values of its places.
    std::string filled(std::string word) const {
        for (const auto &[place, value] : places_) {
            const std::string written = "{" + place + "}";
            for (size_t at = word.find(written); at != std::string::npos;
                 at = word.find(written, at + value.size())) {
                word.replace(at, written.size(), value);
            }
        }
        return word;
    }

    std::string name_;
    std::vector<std::string> words_;
    std::map<std::string, std::string> places_;
};

class OtherSource : public CurveSource {
  public:
    OtherSource(const CurveDescription &curve, const fs::path &scene_file,
                const RenderSettings &settings, fs::path folder)
        : width_(settings.width), height_(settings.height), folder_(std::move(folder)) {
        create_folder(folder_);
        if (curve.other->engine == "command") {
            program_ = std::make_unique<Command>(curve, scene_file, settings);
        } else {
            program_ =
                std::make_unique<InstalledRenderer>(*curve.other, scene_file, settings, folder_);
        }
    }
    OtherSource(const OtherSource &) = delete;
    OtherSource &operator=(const OtherSource &) = delete;
    ~OtherSource() override {
        program_.reset();
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }

    void restart(uint32_t seed) override {
        seed_ = seed;
        images_ = 0;
    }

    TimedImage render_to(uint64_t spp) override {
        const bool is_first = program_->compiles_by_count() ? warm_.insert(spp).second
                                                            : std::exchange(is_cold_, false);
        if (is_first) {
            render(spp, warm_up_seed);
        }
        return render_next(spp);
    }

    std::vector<Image> independent_images(uint32_t seed, uint64_t spp, uint64_t count) override {
        std::vector<Image> images;
        for (uint64_t i = 0; i < count; ++i) {
            restart(seed + static_cast<uint32_t>(i));
            images.push_back(render_next(spp / count).image);
        }
        return images;
    }

    nlohmann::json description() const override { return {{"engine", program_->name()}}; }

  private:
    static constexpr uint32_t warm_up_seed = 1;
    static constexpr uint32_t most_images = 1000;  ///< of one seed

    /// Renders the next image of a seed. No other image has its seed.
    TimedImage render_next(uint64_t spp) { return render(spp, seed_ * most_images + images_++); }

    TimedImage render(uint64_t spp, uint32_t seed) {
        require_not_interrupted();
        const Request request{spp, seed, folder_ / "image.exr"};
        try {
            const double seconds = program_->render(request);
            TimedImage rendered{read_exr(request.output), seconds, seconds};
            fs::remove(request.output);
            require_picture(rendered.image);
            return rendered;
        } catch (const Error &) {
            require_not_interrupted();  // Ctrl-C also ends the program, which then fails
            throw;
        }
    }

    void require_picture(const Image &image) const {
        if (image.width() != width_ || image.height() != height_) {
            throw run_error(fmt::format("'{}' rendered {}x{} pixels, expected {}x{}",
                                        program_->name(), image.width(), image.height(), width_,
                                        height_));
        }
        for (const std::string &name : rgb_names()) {
            const auto &values = image.channel(name);
            if (!std::all_of(values.begin(), values.end(),
                             [](float value) { return std::isfinite(value); })) {
                throw run_error(fmt::format("'{}' rendered a pixel that is not finite in {}",
                                            program_->name(), name));
            }
        }
    }

    int width_, height_;
    fs::path folder_;
    std::unique_ptr<Program> program_;
    std::set<uint64_t> warm_;  ///< numbers of samples whose kernels are compiled
    bool is_cold_ = true;
    uint32_t seed_ = 0, images_ = 0;
};

}  // namespace

std::unique_ptr<CurveSource> other_source(const CurveDescription &curve, const fs::path &scene_file,
                                          const RenderSettings &settings, const fs::path &folder) {
    return std::make_unique<OtherSource>(curve, scene_file, settings, folder);
}

}  // namespace rtrays
