// SPDX-License-Identifier: MIT
#include "reference/peer.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/base/process.h"
#include "renderer/base/progress.h"
#include "renderer/base/resources.h"
#include "renderer/export/export_scene.h"

namespace rtrays::reference {

namespace fs = std::filesystem;

namespace {

/// Properties of a program.
struct PeerKind {
    const char *name, *scene_file;
    /// Large enough that the start of a render is cheap in comparison, small enough for the memory.
    uint64_t samples_per_step;
    /// Command lines. The arguments of the driver are appended to `render`.
    std::vector<std::string> version, render;
    const char *version_prefix;  ///< precedes the first line that the version command prints
    std::string version_suffix;  ///< other properties that the image depends on
};

PeerKind kind_of(const std::string &name) {
    const std::string python = resource_folder() / "build/peers/bin/python";
    const std::string scripts = resource_folder() / "scripts/rtrays/peers";
    if (name == "mitsuba") {
        return {"mitsuba",
                "scene.xml",
                64,
                {python, "-c", "import mitsuba; print(mitsuba.__version__)"},
                {python, scripts + "/mitsuba_driver.py"},
                "Mitsuba ",
                " llvm_ad_rgb"};
    }
    return {"cycles",
            "scene.blender.json",
            256,
            {"blender", "--version"},
            {"blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
             scripts + "/cycles_driver.py", "--"},
            "Cycles of ",
            ", Sobol"};
}

std::string version_of(const PeerKind &kind) {
    Process program(kind.version, python_environment());
    const auto line = program.read_line();
    if (!line) {
        throw Error(ExitCode::skipped,
                    fmt::format("{} is not installed; run scripts/install --peers", kind.name));
    }
    while (program.read_line()) {
    }
    return kind.version_prefix + *line + kind.version_suffix;
}

/// Returns the seed of the first step. Each half has a million steps, so halves never share a seed.
uint64_t first_seed(uint64_t seed) {
    return seed << 20;
}

}  // namespace

struct PeerRenderer::State {
    PeerKind kind;
    ReferenceSettings settings;
    fs::path folder;
    std::string engine;
    Film film;
    double seconds = 0;
    std::optional<Process> process;  ///< renders the steps that follow

    void start(uint64_t begin, uint64_t end) {
        std::vector<std::string> command = kind.render;
        const std::vector<std::string> arguments = {
            (folder / kind.scene_file).string(),
            (folder / "step.exr").string(),
            "--spp",
            std::to_string(kind.samples_per_step),
            "--seed",
            std::to_string(first_seed(settings.seed) + begin),
            "--max-depth",
            std::to_string(settings.max_depth),
            "--runs",
            std::to_string(end - begin)};
        command.insert(command.end(), arguments.begin(), arguments.end());
        process.emplace(command, python_environment());
    }

    /// Returns the record that the driver prints for the next image.
    Json next_record() {
        while (const auto line = process->read_line()) {
            if (line->rfind("{\"file\"", 0) == 0) {
                return parse_json(*line, engine);
            }
        }
        throw run_error(fmt::format("{}: ended with exit code {} before all images were rendered",
                                    engine, process->wait()));
    }

    /// Adds the image of a step.
    void add(const Image &image, uint64_t step) {
        if (image.width() != film.width || image.height() != film.height) {
            throw run_error(fmt::format("{}: unexpected image size {}x{}", engine, image.width(),
                                        image.height()));
        }
        const auto names = rgb_names();
        for (size_t i = 0; i < film.pixels.size(); ++i) {
            const Spectrum value(static_cast<double>(image.channel(names[0])[i]),
                                 static_cast<double>(image.channel(names[1])[i]),
                                 static_cast<double>(image.channel(names[2])[i]));
            if (!film.pixels[i].add(value)) {
                throw run_error(fmt::format("{}: pixel {},{} is not finite or out of range", engine,
                                            i % static_cast<size_t>(film.width),
                                            i / static_cast<size_t>(film.width)));
            }
        }
        film.add({step, step + 1});
    }
};

PeerRenderer::PeerRenderer(const Scene &scene, const ReferenceSettings &settings,
                           const std::string &engine, fs::path folder)
    : state_(new State{kind_of(engine),
                       settings,
                       std::move(folder),
                       {},
                       Film(settings.width, settings.height),
                       0,
                       {}}) {
    state_->engine = version_of(state_->kind);
    fs::create_directories(state_->folder);
    export_scene(scene, state_->folder / state_->kind.scene_file);
}

PeerRenderer::~PeerRenderer() {
    state_->process.reset();
    std::error_code ignored;
    fs::remove_all(state_->folder, ignored);
}

const std::string &PeerRenderer::engine() const {
    return state_->engine;
}

uint64_t PeerRenderer::samples_per_step() const {
    return state_->kind.samples_per_step;
}

uint64_t PeerRenderer::steps_for(uint64_t samples) const {
    return std::max<uint64_t>(2, (samples + samples_per_step() - 1) / samples_per_step());
}

uint64_t PeerRenderer::batch_size() const {
    return 1;
}

uint64_t PeerRenderer::render(uint64_t begin, uint64_t end) {
    State &s = *state_;
    if (!s.process) {
        s.start(begin, std::max(end, last_step_));
    }
    for (; begin < end && !interrupted(); ++begin) {
        const Json record = s.next_record();
        const fs::path file = record.at("file").get<std::string>();
        s.add(read_exr(file), begin);
        fs::remove(file);
        s.seconds += record.at("seconds").get<double>();
    }
    return begin;
}

double PeerRenderer::seconds() const {
    return state_->seconds;
}

uint64_t PeerRenderer::samples() const {
    return state_->film.count();
}

const Film &PeerRenderer::film() const {
    return state_->film;
}

void PeerRenderer::restore(Film film, double seconds) {
    state_->film = std::move(film);
    state_->seconds = seconds;
}

Image PeerRenderer::develop() const {
    Image image = state_->film.develop(seconds());
    const uint64_t spp = samples() * samples_per_step();
    image.channel("samples").assign(image.pixel_count(), static_cast<float>(spp));
    image.attributes()["samplesPerPixel"] = static_cast<int>(spp);
    return image;
}

}  // namespace rtrays::reference
