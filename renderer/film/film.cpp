// SPDX-License-Identifier: MIT
#include "renderer/film/film.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/json.h"
#include "renderer/shared/film_layout.h"

namespace rtrays {

namespace {

constexpr int state_version = 5;
const std::string magic = "RTRaysFilm";

size_t pixel_words(const FilmState &film) {
    return FILM_PIXEL_WORDS(film.variance, film.sequences);
}

/// Returns the number of words of one pass.
size_t word_count(const FilmState &film) {
    return static_cast<size_t>(film.width) * static_cast<size_t>(film.height) * pixel_words(film);
}

/// Returns the value of one sum whose words are `stride` apart: the sum of its words times their
/// units. After carry propagation, all words except the top one are non-negative and smaller than
/// the unit above. Adding from the top therefore cancels only where the result is exact, and the
/// twelve roundings of 2^-53 keep the error below 2^-49 of the result.
double sum_value(const int64_t *words, size_t stride, int lowest, int step) {
    double value = 0;
    for (int k = FILM_WORDS - 1; k >= 0; --k) {
        value += std::ldexp(static_cast<double>(words[static_cast<size_t>(k) * stride]),
                            lowest + k * step);
    }
    return value;
}

/// Means of one channel over the samples of each pixel, and the variances of these means.
struct Means {
    explicit Means(size_t pixels) : mean(pixels), variance(pixels) {}

    void add(const Means &other) {
        for (size_t pixel = 0; pixel < mean.size(); ++pixel) {
            mean[pixel] += other.mean[pixel];
            variance[pixel] += other.variance[pixel];
        }
    }

    std::vector<double> mean, variance;
};

/// Returns the total of the sums of a channel, whose carries have been propagated. The total is
/// exact before it is rounded.
double total_value(const int64_t *words, size_t stride, size_t groups) {
    std::array<int64_t, FILM_WORDS> total{};
    for (size_t word = 0; word < FILM_WORDS; ++word) {
        for (size_t group = 0; group < groups; ++group) {
            total.at(word) += words[word * stride + group * FILM_CHANNELS];
        }
    }
    film_carry_sum(total.data(), 1, 0, FILM_SUM_STEP);
    return sum_value(total.data(), 1, FILM_SUM_LOWEST, FILM_SUM_STEP);
}

/// Numbers of samples of the Sobol sequences.
using SequenceCounts = std::array<uint64_t, SOBOL_SEQUENCES>;

/// Returns the numbers for the first `samples` samples of a film.
SequenceCounts sequence_counts(const FilmState &film, uint64_t samples) {
    SequenceCounts counts{};
    for (const SampleRange &range : film.ranges) {
        const uint64_t end = std::min(range.end, range.begin + samples);
        for (uint64_t sequence = 0; sequence < SOBOL_SEQUENCES; ++sequence) {
            const auto before = [&](uint64_t sample) {
                return (sample + SOBOL_SEQUENCES - 1 - sequence) / SOBOL_SEQUENCES;
            };
            counts.at(sequence) += before(end) - before(range.begin);
        }
        samples -= end - range.begin;
    }
    return counts;
}

/// Returns the variance of the mean of one channel, from the scatter of the means of the Sobol
/// sequences. A sequence with more samples than another has more weight, as if its samples were
/// independent.
double scatter_of_sequences(const int64_t *words, const SequenceCounts &counts, double mean) {
    double squares = 0, used = 0, samples = 0;
    for (size_t sequence = 0; sequence < SOBOL_SEQUENCES; ++sequence) {
        if (counts.at(sequence) == 0) {
            continue;
        }
        const auto n = static_cast<double>(counts.at(sequence));
        const double own = sum_value(words + sequence * FILM_CHANNELS, FILM_PIXEL_SUMS(true, true),
                                     FILM_SUM_LOWEST, FILM_SUM_STEP) /
                           n;
        squares += n * (own - mean) * (own - mean);
        samples += n;
        ++used;
    }
    return used > 1 ? squares / (used - 1) / samples : 0;
}

/// Returns the means of one channel of a pass. The variances are 0 if the film does not know them.
Means pass_means(const FilmState &film, size_t pass, size_t channel) {
    // A sample of a camera pass is one path per pixel. A sample of a light pass is the sum over
    // `light_paths` paths.
    const bool splats = film.passes[pass] == PassKind::light;
    const double paths = splats ? static_cast<double>(film.light_paths) : 1.0;
    const bool stops = !splats && film.convergence;
    const size_t sums = FILM_PIXEL_SUMS(film.variance, film.sequences);
    const int64_t *const first = film.words.data() + pass * word_count(film) + channel;
    Means means(word_count(film) / pixel_words(film));
    SequenceCounts counts = sequence_counts(film, film.samples());
    for (size_t pixel = 0; pixel < means.mean.size(); ++pixel) {
        const int64_t *words = first + pixel * pixel_words(film);
        const uint64_t samples =
            stops ? film.convergence->samples_of(pixel, film.samples()) : film.samples();
        const auto n = static_cast<double>(samples);
        const double own = total_value(words, sums, FILM_GROUPS(film.sequences)) / n;
        means.mean[pixel] = own;
        if (film.sequences) {
            counts = stops ? sequence_counts(film, samples) : counts;
            means.variance[pixel] = scatter_of_sequences(words, counts, own);
        } else if (film.variance && n * paths > 1) {
            // Each square is rounded by up to 2^-21. If all samples are equal, the difference may
            // fall below zero by that fraction of the mean's square, and 0 is the nearest variance.
            const double square =
                sum_value(words + FILM_CHANNELS, sums, FILM_SQUARE_LOWEST, FILM_SQUARE_STEP) / n;
            means.variance[pixel] = std::max(square - own * own / paths, 0.0) / (n - 1.0 / paths);
        }
    }
    return means;
}

void copy_to_floats(const std::vector<double> &values, std::vector<float> &floats) {
    std::transform(values.begin(), values.end(), floats.begin(),
                   [](double value) { return static_cast<float>(value); });
}

std::string pass_names(const FilmState &film) {
    std::vector<std::string> names;
    for (const PassKind pass : film.passes) {
        names.push_back(to_string(pass));
    }
    return fmt::to_string(fmt::join(names, " and "));
}

/// Returns what two films share if samples of one can be added to the other, with values as text.
/// In the order of names, a setting comes before the properties that follow from it.
std::map<std::string, std::string> identity_of(const FilmState &film, bool with_passes) {
    const auto yes_no = [](bool value) { return value ? "yes" : "no"; };
    std::map<std::string, std::string> identity = film.config;
    identity["size"] = fmt::format("{} x {}", film.width, film.height);
    identity["seed"] = fmt::to_string(film.seed);
    identity["sums for variances"] = yes_no(film.variance);
    identity["sums of sequences"] = yes_no(film.sequences);
    if (with_passes) {
        identity["passes"] = pass_names(film);
        identity["stopped pixels"] = yes_no(film.convergence.has_value());
    }
    return identity;
}

/// Returns a film with the fields of a file's header, and words of 0. `fail` makes an error of that
/// file.
template <typename Fail>
FilmState film_of_header(const Json &header, const Fail &fail) {
    if (header.at("version").get<int>() != state_version) {
        throw fail("film state of another version of the program; render it again");
    }
    FilmState film;
    film.width = header.at("width");
    film.height = header.at("height");
    film.variance = header.at("variance");
    film.sequences = header.at("sequences");
    film.seed = header.at("seed");
    film.config = header.at("config").get<std::map<std::string, std::string>>();
    film.device_seconds = header.at("device_seconds");
    film.wall_seconds = header.at("wall_seconds");
    film.passes.clear();
    for (const Json &name : header.at("passes")) {
        const std::optional<PassKind> pass = find_named(pass_kinds, name.get<std::string>());
        if (!pass) {
            throw fail("film state with an unknown pass; render it again");
        }
        film.passes.push_back(*pass);
    }
    film.light_paths = header.at("light_paths");
    film.non_finite = header.at("non_finite");
    film.out_of_range = header.at("out_of_range");
    for (const Json &range : header.at("ranges")) {
        film.add_range({range.at(0), range.at(1)});
    }
    film.words.resize(film.passes.size() * word_count(film));
    if (header.contains("convergence")) {
        const Json &rule = header.at("convergence");
        const size_t pixels = word_count(film) / pixel_words(film);
        film.convergence =
            ConvergenceState{{rule.at("error"), rule.at("interval"), rule.at("start")},
                             std::vector<uint64_t>(pixels),
                             std::vector<int64_t>(pixels * HALF_FILM_PIXEL_WORDS)};
    }
    return film;
}

}  // namespace

uint64_t FilmState::samples() const {
    return count_samples(ranges);
}

std::string FilmState::config_hash() const {
    return content_hash(Json(config).dump());
}

void FilmState::add_range(SampleRange range) {
    rtrays::add_range(ranges, range);
}

void require_valid(const FilmState &film) {
    if (film.non_finite > 0 || film.out_of_range > 0) {
        throw run_error(
            fmt::format("{} samples were not finite and {} beyond the film's range of 2^40; they "
                        "are not in the image",
                        film.non_finite, film.out_of_range));
    }
}

Image develop_film(const FilmState &film) {
    Image image = Image::rgb(film.width, film.height);
    const std::vector<std::string> colour = rgb_names(), variance = rgb_names("variance");
    if (film.variance) {
        for (const std::string &name : variance) {
            image.add_channel(name);
        }
    }
    std::vector<float> &samples = image.add_channel("samples");
    for (size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        samples[pixel] = static_cast<float>(
            film.convergence ? film.convergence->samples_of(pixel, film.samples())
                             : film.samples());
    }
    const bool layers = film.passes.size() > 1;
    for (size_t pass = 0; pass < film.passes.size() && layers; ++pass) {
        for (const std::string &name : rgb_names(to_string(film.passes[pass]))) {
            image.add_channel(name);
        }
    }
    if (film.samples() == 0) {
        return image;
    }
    for (size_t c = 0; c < FILM_CHANNELS; ++c) {
        Means all(image.pixel_count());
        for (size_t pass = 0; pass < film.passes.size(); ++pass) {
            const Means own = pass_means(film, pass, c);
            all.add(own);
            if (layers) {
                copy_to_floats(own.mean, image.channel(rgb_names(to_string(film.passes[pass]))[c]));
            }
        }
        copy_to_floats(all.mean, image.channel(colour[c]));
        if (film.variance) {
            copy_to_floats(all.variance, image.channel(variance[c]));
        }
    }
    return image;
}

std::optional<FilmDifference> find_difference(const FilmState &first, const FilmState &second,
                                              bool compare_passes) {
    const auto one = identity_of(first, compare_passes), two = identity_of(second, compare_passes);
    const auto value = [](const auto &identity, const std::string &name) {
        const auto found = identity.find(name);
        return found == identity.end() ? "none" : found->second;
    };
    auto names = one;
    names.insert(two.begin(), two.end());
    for (const auto &entry : names) {
        const std::string &name = entry.first;
        if (value(one, name) != value(two, name)) {
            return FilmDifference{name, value(one, name), value(two, name)};
        }
    }
    return std::nullopt;
}

void merge_film(FilmState &film, const FilmState &other) {
    const bool other_pass =
        film.passes != other.passes && film.passes.size() == 1 && other.passes.size() == 1;
    if (const auto difference = find_difference(film, other, !other_pass)) {
        throw input_error(fmt::format("films differ in {} ({} and {}) and cannot be merged",
                                      difference->name, difference->first, difference->second));
    }
    FilmState merged = film;
    if (other_pass) {
        if (film.ranges != other.ranges) {
            throw input_error(
                "different passes must have the same samples; render the missing ones");
        }
    } else if (film.convergence || other.convergence) {
        throw input_error(
            "films with convergence control depend on the order of their samples; only another "
            "pass can be merged into them");
    } else {
        for (const SampleRange &range : other.ranges) {
            merged.add_range(range);
        }
    }
    merged.device_seconds += other.device_seconds;
    merged.wall_seconds += other.wall_seconds;
    merged.non_finite += other.non_finite;
    merged.out_of_range += other.out_of_range;
    if (other_pass) {
        const bool first = film.passes.front() == PassKind::camera;
        const FilmState &camera = first ? film : other, &light = first ? other : film;
        merged.passes = {camera.passes.front(), light.passes.front()};
        merged.light_paths = light.light_paths;
        merged.words = camera.words;
        merged.words.insert(merged.words.end(), light.words.begin(), light.words.end());
        merged.convergence = camera.convergence;
        film = std::move(merged);
        return;
    }
    for (size_t i = 0; i < merged.words.size(); ++i) {
        merged.words[i] += other.words[i];
    }
    carry_words(merged);
    film = std::move(merged);
}

void carry_words(FilmState &film) {
    const uint32_t sums = FILM_PIXEL_SUMS(film.variance, film.sequences);
    const bool squares = film.variance && !film.sequences;
    for (size_t pixel = 0; pixel < film.words.size(); pixel += pixel_words(film)) {
        for (uint32_t sum = 0; sum < sums; ++sum) {
            film_carry_sum(film.words.data() + pixel, sums, sum, film_step(sum, squares));
        }
    }
}

void save_film(const FilmState &film, const std::filesystem::path &path) {
    Json header = {{"version", state_version},
                   {"width", film.width},
                   {"height", film.height},
                   {"variance", film.variance},
                   {"sequences", film.sequences},
                   {"seed", film.seed},
                   {"config", film.config},
                   {"ranges", Json::array()},
                   {"device_seconds", film.device_seconds},
                   {"non_finite", film.non_finite},
                   {"out_of_range", film.out_of_range},
                   {"wall_seconds", film.wall_seconds},
                   {"passes", Json::array()},
                   {"light_paths", film.light_paths}};
    for (const PassKind pass : film.passes) {
        header["passes"].push_back(to_string(pass));
    }
    for (const SampleRange &range : film.ranges) {
        header["ranges"].push_back({range.begin, range.end});
    }
    if (film.convergence) {
        const ConvergenceRule &rule = film.convergence->rule;
        header["convergence"] = {
            {"error", rule.error}, {"interval", rule.interval}, {"start", rule.start}};
    }
    std::string content = magic + "\n" + header.dump() + "\n";
    const auto append = [&](const auto &values) {
        content.append(reinterpret_cast<const char *>(values.data()),
                       values.size() * sizeof values[0]);
    };
    append(film.words);
    if (film.convergence) {
        append(film.convergence->stopped_at);
        append(film.convergence->half_words);
    }
    write_file(path, content_hash(content) + content);
}

FilmState load_film(const std::filesystem::path &path) {
    const std::string file = read_file(path);
    const auto fail = [&](const char *why) {
        return input_error(fmt::format("{}: {}", path.string(), why));
    };
    if (file.compare(std::min(hash_digits, file.size()), magic.size(), magic) != 0) {
        throw fail("not a film state; expected a file that --state wrote");
    }
    const std::string content = file.substr(hash_digits);
    if (content_hash(content) != file.substr(0, hash_digits)) {
        throw fail("film state is truncated or damaged (checksum); render it again");
    }
    const size_t header_begin = magic.size() + 1;
    const size_t header_end = content.find('\n', header_begin);
    const Json header =
        parse_json(content.substr(header_begin, header_end - header_begin), path.string());
    FilmState film = film_of_header(header, fail);
    size_t at = header_end + 1;
    const auto take = [&](auto &values) {
        const size_t bytes = values.size() * sizeof values[0];
        if (bytes > content.size() - at) {
            throw fail("film state has the wrong length; render it again");
        }
        std::memcpy(values.data(), content.data() + at, bytes);
        at += bytes;
    };
    take(film.words);
    if (film.convergence) {
        take(film.convergence->stopped_at);
        take(film.convergence->half_words);
    }
    if (at != content.size()) {
        throw fail("film state has the wrong length; render it again");
    }
    if (film.convergence && !film.convergence->is_consistent(film.samples())) {
        throw fail("film state has pixels that stopped between checks; render it again");
    }
    return film;
}

}  // namespace rtrays
