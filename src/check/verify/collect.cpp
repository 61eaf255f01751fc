#include "collect.h"

#include <bit>
#include <chrono>
#include <utility>

#include "describe/guard.h"
#include "etendue/describe/declared_class.h"
#include "etendue/language/language.h"
#include "etendue/render/follows_polarization.h"
#include "etendue/render/shrinking_bias.h"
#include "limit.h"

namespace etendue::verify {
namespace {

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The means of one pass, at layout.index.
std::vector<double> means(const Layout& layout, const Image& picture) {
  std::vector<size_t> channel;
  for (const Layer& layer : layout.layers)
    channel.push_back(layer.length == 0 ? size_t(layer.channel - 'X') : size_t(3 * layer.length + (layer.channel - 'X')));
  std::vector<double> result(layout.count());
  const PixelArea all = layout.area(layout.whole());
  for (size_t tile = 0; tile < layout.tiles.size(); ++tile) {
    const PixelArea& area = layout.tiles[tile];
    for (size_t layer = 0; layer < channel.size(); ++layer) {
      double sum = 0;
      for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x) sum += picture.at(x - all.x0, y - all.y0, channel[layer]);
      result[layout.index(layer, tile)] = sum / layout.pixels(tile);
      result[layout.index(layer, layout.whole())] += sum / layout.pixels(layout.whole());
    }
  }
  return result;
}

}  // namespace

std::string trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r\n"), end = text.find_last_not_of(" \t\r\n");
  return begin == std::string::npos ? std::string() : text.substr(begin, end - begin + 1);
}

std::vector<std::string> missed_light(const Renderer& renderer, const SceneTraits& traits) {
  std::vector<std::string> lost;
  for (const Advice& advice : renderer.misses(traits)) lost.push_back(advice.lost);
  return lost;
}

std::vector<std::string> split_expressions(const std::string& list) {
  std::vector<std::string> parts(1);
  int depth = 0;
  bool text = false;
  for (size_t i = 0; i < list.size(); ++i) {
    const char c = list[i];
    if (text) {
      if (c == '"') text = false;
      if (c == '\\' && i + 1 < list.size()) parts.back() += list[i++];
    } else if (c == '"') {
      text = true;
    } else if (c == '{' || c == '[' || c == '(') {
      ++depth;
    } else if (c == '}' || c == ']' || c == ')') {
      --depth;
    } else if (c == ',' && depth == 0) {
      parts.emplace_back();
      continue;
    }
    parts.back() += list[i];
  }
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

std::vector<NamedRenderer> named_renderers(const Job& job, const std::string& list) {
  std::vector<NamedRenderer> all;
  if (trimmed(list).empty()) return all;
  std::vector<Error> errors;
  for (const std::string& expression : split_expressions(list)) {
    try {
      if (expression.empty()) throw Error("a name is missing in '" + list + "'", {intern("--renderers"), 0, 0});
      all.push_back({expression, named_renderer(job, expression, "--renderers")});
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
  return all;
}

namespace {

/// Throws Errors for names that occur twice.
void require_different(const std::vector<NamedRenderer>& all) {
  std::vector<Error> errors;
  for (auto one = all.begin(); one != all.end(); ++one)
    if (std::ranges::find(all.begin(), one, one->name, &NamedRenderer::name) != one)
      errors.push_back(Error(fmt::format("'{}' is named twice", one->name), {intern("--renderers"), 0, 0}));
  if (!errors.empty()) throw Errors(std::move(errors));
}

/// The job's own renderer, and one of each other class.
std::vector<NamedRenderer> all_renderers(const Job& job) {
  const std::string own_class = job.renderer->class_info().name;
  std::vector<NamedRenderer> all{{own_class, job.renderer}};
  const Registry& registry = Registry::instance();
  for (const ClassInfo* info : registry.subclasses(*registry.find("Renderer")))
    if (info->name != own_class) all.push_back({info->name, ref_cast<Renderer>(create(*info))});
  return all;
}

}  // namespace

Choice choose_renderers(const Job& job, const std::string& list, bool force) {
  return choose_renderers(job, named_renderers(job, list), force);
}

Choice choose_renderers(const Job& job, const std::vector<NamedRenderer>& given, bool force) {
  const bool named = !given.empty();
  require_different(given);
  const SceneTraits traits = scene_traits(*job.scene, *job.camera);
  const bool polarized = !polarizing_plates(*job.scene).empty();
  Choice choice;
  for (const NamedRenderer& one : named ? given : all_renderers(job)) {
    Candidate candidate{one.name, one.renderer, {}};
    if (candidate.renderer != job.renderer) {
      try {
        take_over(*candidate.renderer, *job.renderer);
      } catch (const Error& error) {  // thrown for a max_depth above the renderer's limit
        choice.left_out.push_back(
            {candidate.name, std::string("cannot take over what the file's renderer has: ") + error.what()});
        continue;
      }
      prepare_tree(*candidate.renderer);
    }
    candidate.misses = missed_light(*candidate.renderer, traits);
    const bool follows = follows_polarization(*candidate.renderer);
    if (follows && !named && candidate.renderer != job.renderer)
      choice.left_out.push_back({candidate.name,
                                 "follows the polarization of light, on which the picture may depend; "
                                 "--renderers compares it nevertheless"});
    else if (polarized && !follows && !(force && named))
      choice.left_out.push_back({candidate.name, "does not follow the polarization of light, on which the picture depends"});
    else if (!candidate.misses.empty() && !(force && named))
      choice.left_out.push_back({candidate.name, "misses " + joined(candidate.misses)});
    else if (const std::string bias = candidate.renderer->bias(); !bias.empty() && !named)
      choice.left_out.push_back({candidate.name, "is biased: " + bias + "; --renderers compares it nevertheless"});
    else
      choice.candidates.push_back(std::move(candidate));
  }
  return choice;
}

void require_two(const Choice& choice) {
  if (choice.candidates.size() >= 2) return;
  std::string message = choice.candidates.empty()
                            ? "there is no renderer to compare"
                            : "there is only " + choice.candidates.front().name + ", and no other renderer to compare it with";
  for (const LeftOut& left : choice.left_out) message += fmt::format("\n  {}: {}", left.name, left.reason);
  throw Error(message +
              "\nname others with --renderers, such as 'PathTracer{next_event: false}'; --force keeps those that miss light");
}

std::string without_lengths(const Choice& choice) {
  for (const Candidate& candidate : choice.candidates)
    if (dynamic_cast<const DeclaredMembers*>(candidate.renderer.get())) return candidate.name;
  return {};
}

void prepare_picture(Job& job, int lengths) {
  if (!job.image) return;  // an error is thrown when the job is prepared
  job.image->filter = ref_cast<Filter>(Registry::instance().create("BoxFilter"));
  job.image->layers.clear();
  set(*job.image, "path_lengths", Value(Number{double(lengths)}));
  job.time_limit = job.error_limit = 0;
}

int default_tile(const ImageBuffer& image) {
  const int side = std::min(image.area().width(), image.area().height());
  return int(std::bit_floor(unsigned(std::clamp(side / 8, 4, 32))));
}

namespace {

/// Continues the current pass to so many samples and returns its image; empty when interrupted.
std::optional<Image> picture_at(Render& render, std::uint32_t samples) {
  render.edit(*render.job().renderer, "samples", Value(Number{double(samples)}));
  if (render.run() != Ended::samples) return {};
  return render.film().develop();
}

std::vector<double> tile_luminances(const Layout& layout, const std::vector<double>& means) {
  return {means.begin(), means.begin() + std::ptrdiff_t(layout.tiles.size())};  // layer 0 is Y of all lengths
}

/// Renders one more pass; false when interrupted. `systematic` accumulates the uncertainty of extrapolated limits.
bool add_pass(Render& render, const Layout& layout, double factor, const CollectOptions& options, const LimitOfPass* limit,
              Measured& measured, RendererRun& run) {
  std::vector<std::vector<double>> seen;
  Image picture;
  std::vector<std::uint32_t> marks{std::uint32_t(options.samples)};
  if (limit) marks = limit->marks();
  for (const std::uint32_t mark : marks) {
    std::optional<Image> now = picture_at(render, mark);
    if (!now) return false;
    picture = std::move(*now);
    seen.push_back(means(layout, picture));
    for (double& value : seen.back()) value *= factor;
  }
  if (limit) {
    std::vector<double> limits(layout.count());
    measured.systematic.resize(layout.count());
    for (size_t i = 0; i < limits.size(); ++i) {
      std::vector<double> at_marks;
      for (const auto& each : seen) at_marks.push_back(each[i]);
      const double by_width = limit->limit_by_width(at_marks), by_square = limit->limit_by_square(at_marks);
      limits[i] = 0.5 * (by_width + by_square);
      measured.systematic[i] += 0.5 * (by_width - by_square);
    }
    measured.passes.push_back(std::move(limits));
    auto& tiles = run.tiles_at_marks.emplace_back();
    for (const auto& each : seen) tiles.push_back(tile_luminances(layout, each));
  } else {
    measured.passes.push_back(std::move(seen.back()));
  }
  const size_t channels = picture.channels.size();
  for (size_t i = 0; i < run.picture.values.size(); ++i)
    run.picture.values[i] += factor * picture.values[i / 3 * channels + i % 3];
  run.bad_samples += render.film().bad_samples();
  run.samples += render.film().samples();
  return true;
}

/// The extrapolation for a renderer whose limit can be estimated from its steps; empty for others.
std::optional<LimitOfPass> limit_of(const Render& render, const Renderer& renderer, int samples) {
  if (!tells_limit(renderer)) return {};
  const auto& shrinking = dynamic_cast<const ShrinkingBias&>(renderer);
  return LimitOfPass(std::uint32_t(samples), render.samples_per_step(),
                     [&](std::uint32_t step) { return shrinking.bias_width(step); });
}

double share_with_length(const Layout& layout, const Measured& measured) {
  double total = 0, told = 0;
  for (const auto& pass : measured.passes)
    for (size_t layer = 0; layer < layout.layers.size(); ++layer) {
      const double mean = pass[layout.index(layer, layout.whole())];
      if (layer == 0) total += mean;
      if (layout.layers[layer].length > 0) told += mean;
    }
  return total > 0 ? told / total : 1;
}

/// Renders all passes of one renderer; false when interrupted.
bool measure(Render& render, size_t number, const Candidate& candidate, const CollectOptions& options, std::uint64_t seed,
             Collected& all) {
  const Ref<Renderer>& renderer = candidate.renderer;
  render.edit(render.job(), "renderer", Value(Ref<Component>(renderer)));
  const int own_samples = renderer->samples;
  render.edit(*renderer, "samples", Value(Number{double(options.samples)}));
  const std::optional<LimitOfPass> limit = limit_of(render, *renderer, options.samples);
  Measured measured;
  measured.name = candidate.name;
  RendererRun run;
  const PixelArea& area = render.job().image->area();
  run.picture = Image(area.width(), area.height(), {"X", "Y", "Z"});
  run.picture.metadata["color_space"] = "xyz";
  const auto enough = [&](size_t passes) {
    constexpr size_t least = 8;
    return options.seconds > 0 ? passes >= least && run.seconds >= options.seconds : passes >= size_t(options.passes);
  };
  bool going = true;
  const double begun = now();
  for (size_t pass = 0; going && !enough(pass); ++pass) {
    // No two passes of any renderers share random numbers.
    render.restart(seed + ((std::uint64_t(number) << 32) + pass) * 0x9e3779b97f4a7c15ull);
    going = (!options.go_on || options.go_on(number, pass)) &&
            add_pass(render, all.layout, number == 0 ? options.inject : 1, options, limit ? &*limit : nullptr, measured, run);
    run.seconds = now() - begun;
  }
  render.edit(*renderer, "samples", Value(Number{double(own_samples)}));
  if (!going) return false;
  for (double& value : run.picture.values) value /= double(measured.passes.size());
  for (double& value : measured.systematic) value = std::abs(value) / double(measured.passes.size());
  if (limit) run.marks = limit->marks(), run.limit_noise = limit->noise();
  run.lengths_asked = all.layout.lengths > 0;
  run.length_share = share_with_length(all.layout, measured);
  measured.tells_lengths = run.length_share > 0;
  all.measured.push_back(std::move(measured));
  all.runs.push_back(std::move(run));
  return true;
}

}  // namespace

bool tells_limit(const Renderer& renderer) {
  const auto* shrinking = dynamic_cast<const ShrinkingBias*>(&renderer);
  return shrinking && renderer.expectation() == Expectation::consistent && !(renderer.map_filter > 0) &&
         shrinking->bias_width(1) > 0 && shrinking->bias_width(1) < shrinking->bias_width(0);
}

void leave_out_refused(Choice& choice, const Collected& collected) {
  for (auto refused = collected.refused.rbegin(); refused != collected.refused.rend(); ++refused) {
    const auto place = choice.candidates.begin() + std::ptrdiff_t(refused->first);
    choice.left_out.push_back({place->name, "refuses the scene: " + refused->second});
    choice.candidates.erase(place);
  }
}

Collected collect(Render& render, const std::vector<Candidate>& candidates, int tile, const CollectOptions& options) {
  const Ref<Renderer> own = render.job().renderer;
  const std::uint64_t seed = render.job().seed;
  Collected all;
  all.layout = Layout::of(render.job().image->area(), tile, render.job().image->path_lengths);
  all.complete = true;
  for (size_t i = 0; all.complete && i < candidates.size(); ++i) {
    std::string refusal;
    try {
      all.complete = measure(render, i, candidates[i], options, seed, all);
    } catch (const Error& error) {
      if (!options.leave_out_refusing || i == 0) throw;
      refusal = error.what();
    } catch (const Errors& several) {
      if (!options.leave_out_refusing || i == 0) throw;
      refusal = several.errors.front().what();
    }
    if (!refusal.empty()) all.refused.emplace_back(i, refusal);
  }
  render.edit(render.job(), "renderer", Value(Ref<Component>(own)));
  render.restart(seed);
  return all;
}

}  // namespace etendue::verify
