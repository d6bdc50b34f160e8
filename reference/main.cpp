// SPDX-License-Identifier: MIT
// rtrays-reference: renders a scene with the independent Embree path tracer, with Mitsuba or with
// Cycles.
#include <algorithm>
#include <filesystem>
#include <string_view>

#include "reference/command.h"
#include "reference/peer.h"
#include "reference/renderer.h"
#include "renderer/base/clock.h"
#include "renderer/base/error.h"
#include "renderer/base/progress.h"

namespace {

using namespace rtrays;
using namespace rtrays::reference;

namespace fs = std::filesystem;

/// Renders the missing samples until interrupted. Calls `save` in intervals and at the end.
template <class Renderer, class Save>
void render_missing(const Options &options, const Steps &steps, Renderer &renderer,
                    const Save &save) {
    Progress progress(fs::path(options.output).filename().string(), options.end - options.begin,
                      "spp", options.quiet);
    progress.update(steps.samples * renderer.samples());
    auto last_save = SteadyClock::now();
    for (SampleRange range : missing_ranges(renderer.film().ranges, steps.range)) {
        while (range.begin < range.end && !interrupted()) {
            range.begin = renderer.render(range.begin,
                                          std::min(range.end, range.begin + renderer.batch_size()));
            progress.update(steps.samples * renderer.samples());
            if (seconds_since(last_save) >= options.checkpoint_interval) {
                save();
                last_save = SteadyClock::now();
            }
        }
    }
    save();
}

/// Renders the missing samples and writes the results. `counts` returns further statistics.
template <class Renderer, class Counts>
ExitCode render_reference(const Options &options, const Steps &steps, const Json &config,
                          Renderer &renderer, const Counts &counts) {
    if (is_done(options, config)) {
        return ExitCode::ok;
    }
    Checkpoint checkpoint = begin_or_resume(options, steps, config);
    renderer.restore(checkpoint.film, checkpoint.seconds);
    install_interrupt_handler();
    render_missing(options, steps, renderer, [&] {
        checkpoint.film = renderer.film();
        checkpoint.seconds = renderer.seconds();
        save_checkpoint(checkpoint, options.state);
    });
    if (!checkpoint.finished()) {
        report_interruption(options, steps.samples * renderer.samples());
        return ExitCode::interrupted;
    }
    write_results(options, steps, checkpoint, renderer.develop(), counts());
    return ExitCode::ok;
}

ExitCode render_by_embree(const Options &options, const Scene &scene) {
    ReferenceRenderer renderer(scene.arrays(), options.settings);
    const Json config =
        make_config(scene.name(), scene.hash(), options.settings, renderer.stats().engine);
    return render_reference(options, {{options.begin, options.end}, 1}, config, renderer,
                            [&] { return describe_counts(renderer, options.settings.threads); });
}

/// Renders with another program. The number of samples is rounded up to whole steps.
ExitCode render_by_peer(Options options, Scene &scene) {
    scene.set_film_size(options.settings.width, options.settings.height);
    PeerRenderer renderer(scene, options.settings, options.engine, options.state + ".scene");
    const uint64_t samples = renderer.samples_per_step();
    const Steps steps{{0, renderer.steps_for(options.end)}, samples};
    options.end = samples * steps.range.end;
    renderer.plan(steps.range.end);
    Json config = make_config(scene.name(), scene.hash(), options.settings, renderer.engine());
    config["samples_per_step"] = samples;
    return render_reference(options, steps, config, renderer, [&] {
        return Json{{"threads", options.settings.threads}};
    });
}

ExitCode parse_and_merge(int argc, char **argv) {
    const auto options = parse_merge_options(argc, argv);
    return options ? merge_states(*options) : ExitCode::ok;
}

ExitCode run(int argc, char **argv) {
    if (argc > 1 && std::string_view(argv[1]) == "merge") {
        return parse_and_merge(argc - 1, argv + 1);
    }
    auto options = parse_options(argc, argv);
    if (!options) {
        return ExitCode::ok;
    }
    require_outputs(*options);
    Scene scene = load_scene(*options);
    return options->engine == "embree" ? render_by_embree(*options, scene)
                                       : render_by_peer(*options, scene);
}

}  // namespace

int main(int argc, char **argv) {
    return rtrays::run_main("rtrays-reference", [&] { return run(argc, argv); });
}
