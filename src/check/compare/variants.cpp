#include "variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "check/verify/collect.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "etendue/transport/scene_traits.h"

namespace etendue::comparing {
namespace {

const char* const form = "NAME: PATH=VALUE, PATH=VALUE, such as 'long paths: renderer.max_depth=64'";

Variant parse_variant(const std::string& text) {
  const Location at{intern("--variant"), 0, 0};
  const size_t colon = text.find(':'), equals = text.find('=');
  if (colon == std::string::npos || colon > equals) throw Error(fmt::format("'{}' is not of the form {}", text, form), at);
  Variant variant{verify::trimmed(text.substr(0, colon)), {}};
  if (variant.name.empty()) throw Error(fmt::format("'{}' has no name before the colon; write {}", text, form), at);
  const std::string rest = verify::trimmed(text.substr(colon + 1));
  if (rest.empty()) return variant;  // the file unchanged
  for (const std::string& part : verify::split_expressions(rest)) {
    const size_t sign = part.find('=');
    if (sign == std::string::npos || sign == 0)
      throw Error(fmt::format("'{}' of variant '{}' is not of the form PATH=VALUE", part, variant.name), at);
    variant.sets.emplace_back(verify::trimmed(part.substr(0, sign)), verify::trimmed(part.substr(sign + 1)));
  }
  return variant;
}

/// Throws Error if a name is unsuitable for a table's heading or a curve's name.
void require_good_name(const Variant& variant, const char* option) {
  constexpr size_t longest = 200;
  if (variant.name.size() > longest)
    throw Error(fmt::format("the name '{}…' has more than {} bytes", variant.name.substr(0, 20), longest),
                {intern(option), 0, 0});
  for (const char c : variant.name)
    if (static_cast<unsigned char>(c) < 32) throw Error("a name has control characters", {intern(option), 0, 0});
}

/// Whether a path names the renderer or a member of it: variants that set nothing else share one prepared scene.
bool only_renderer(const std::string& path) {
  const std::string own = "renderer";
  return path == own || (path.starts_with(own + ".") && path.find_first_of(".[", own.size() + 1) == std::string::npos);
}

void apply(Job& job, const Variant& variant, const Job& described) {
  std::vector<Error> errors;
  if (variant.renderer) {
    const Ref<Renderer> given = ref_cast<Renderer>(copy(*variant.renderer));
    take_over(*given, *described.renderer);
    job.renderer = given;
  }
  for (const auto& [path, expression] : variant.sets) {
    try {
      if (path != "renderer") {
        set_path(job, path, expression);
        continue;
      }
      const Ref<Renderer> named = named_renderer(described, expression, "variant '" + variant.name + "'");
      if (named != described.renderer) take_over(*named, *described.renderer);
      job.renderer = named;
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error) {
      errors.emplace_back(fmt::format("variant '{}': {}", variant.name, error.what()), error.location);
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
}

/// Removes layers and path lengths, which a comparison does not use, from the image, and limits, as the comparison ends the
/// runs.
void prepare_picture(Job& job) {
  if (job.image) {
    job.image->layers.clear();
    job.image->path_lengths = 0;
  }
  job.time_limit = job.error_limit = 0;
}

}  // namespace

std::vector<Variant> parse_variants(const std::string& renderers, const std::vector<std::string>& texts) {
  std::vector<Variant> variants;
  std::vector<Error> errors;
  std::set<std::string> names;
  const auto add = [&](const char* option, const Variant& variant) {
    require_good_name(variant, option);
    if (!names.insert(variant.name).second)
      throw Error(fmt::format("there are two variants '{}': give one another name", variant.name), {intern(option), 0, 0});
    variants.push_back(variant);
  };
  const auto each = [&](auto&& work) {
    try {
      work();
    } catch (const Error& error) {
      errors.push_back(error);
    }
  };
  if (!renderers.empty())
    for (const std::string& expression : verify::split_expressions(renderers))
      each([&] {
        if (expression.empty()) throw Error("a name is missing in '" + renderers + "'", {intern("--renderers"), 0, 0});
        add("--renderers", {expression, {{"renderer", expression}}});
      });
  for (const std::string& text : texts) each([&] { add("--variant", parse_variant(text)); });
  if (!errors.empty()) throw Errors(std::move(errors));
  return variants;
}

SceneSubjects::SceneSubjects(const std::function<Ref<Job>()>& load, const std::vector<Variant>& variants, int threads) {
  Ref<Job> job = load();
  prepare_picture(*job);
  shared_ = std::make_unique<Render>(job, RenderSettings{.threads = threads});
  std::vector<Error> errors;
  for (const Variant& variant : variants) {
    try {
      add(load, variant, threads);
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error) {
      errors.emplace_back(fmt::format("variant '{}': {}", variant.name, error.what()), error.location);
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
}

void SceneSubjects::add(const std::function<Ref<Job>()>& load, const Variant& variant, int threads) {
  const Job& described = shared_->job();
  Subject subject{variant.name, shared_.get(), nullptr, {}, {}};
  const bool shares = std::ranges::all_of(variant.sets, [](const auto& set) { return only_renderer(set.first); });
  if (shares) {
    const Ref<Job> bare = make<Job>();
    bare->renderer = ref_cast<Renderer>(copy(*described.renderer));
    apply(*bare, variant, described);
    if (bare->renderer == described.renderer) bare->renderer = ref_cast<Renderer>(copy(*described.renderer));
    if (!bare->renderer) throw Error("there is no renderer");
    prepare_tree(*bare->renderer);
    subject.renderer = bare->renderer;
  } else {
    const Ref<Job> job = load();
    prepare_picture(*job);
    const Ref<Job> unchanged = make<Job>();
    unchanged->renderer = job->renderer;
    apply(*job, variant, *unchanged);
    own_.push_back(std::make_unique<Render>(job, RenderSettings{.threads = threads}));
    subject.render = own_.back().get();
    subject.renderer = job->renderer;
    const PixelArea &area = job->image->area(), &usual = described.image->area();
    if (area.width() != usual.width() || area.height() != usual.height())
      throw Error(fmt::format("variant '{}' has {} x {} pixels where others have {} x {}: pictures of one size can be compared",
                              variant.name, area.width(), area.height(), usual.width(), usual.height()),
                  {intern("--variant"), 0, 0});
  }
  const Job& job = subject.render->job();
  subject.misses = verify::missed_light(*subject.renderer, scene_traits(*job.scene, *job.camera));
  subject.bias = subject.renderer->bias();
  subjects_.push_back(std::move(subject));
}

Render& SceneSubjects::ready(size_t variant) {
  const Subject& subject = subjects_[variant];
  if (subject.render->job().renderer != subject.renderer)
    subject.render->edit(subject.render->job(), "renderer", Value(Ref<Component>(subject.renderer)));
  return *subject.render;
}

Identity SceneSubjects::identity(size_t variant) { return identity_of(ready(variant).job()); }

}  // namespace etendue::comparing
