#include "denoising.h"

#include <algorithm>
#include <atomic>
#include <map>

#include "etendue/describe/color.h"
#include "etendue/describe/reflection.h"
#include "etendue/film/film.h"
#include "etendue/render/render.h"
#include "etendue/transport/camera_walk.h"
#include "film/image_bands.h"
#include "film/surface_film.h"
#include "parallel_schedule.h"
#include "surface_step.h"
#include "transport/first_surface.h"

namespace etendue {
namespace {

/// The first surface on a camera path that is neither a mirror nor clear glass.
FirstSurface guide_of(const RenderContext& context, const Ray& ray, SampleContext& sample) {
  // Paths between two parallel mirrors would never end.
  constexpr int longest = 32;
  CameraWalk<> walk(context.scene, sample, ray, longest);
  const auto nothing = [](const SurfacePoint&) { return 0.0f; };
  FirstSurface guide;
  guide.key = 1;  // what is met has no name
  while (true) {
    if (!walk.next_vertex(nothing)) {
      if (walk.vertex.kind == PathVertex::Kind::escape && !context.scene.infinite_luminaires(walk.ray).empty())
        guide.albedo = linear_srgb(walk.throughput, sample.wavelengths);
      return guide;
    }
    const PathVertex& v = walk.vertex;
    if (v.in_medium() || v.scatters_smoothly() || v.point.object->luminaire() || walk.at_end()) {
      const bool shines = !v.in_medium() && v.point.object->luminaire();
      const Spectrum scattered = v.on_surface() && v.scatter ? v.scatter->albedo(v.out) : Spectrum();
      guide.albedo = linear_srgb(walk.throughput * (v.in_medium() || shines ? Spectrum(1.0f) : scattered), sample.wavelengths);
      if (v.on_surface())
        guide.normal = Vector3(v.point.shading_normal) * (dot(v.point.shading_normal, v.out) < 0 ? -1.0f : 1.0f);
      return guide;
    }
    if (!walk.scatter(walk.next_bounce())) return guide;
  }
}

/// Whether a channel describes the noise of the original picture or holds a part of its light; neither is valid for the
/// denoised picture.
bool tells_of_noise(const std::string& channel) {
  return channel.starts_with("variance.") || channel.starts_with("length_") || channel.starts_with("light.") ||
         channel.starts_with("path.") || channel.starts_with("polarization.") || channel.starts_with("S1.") ||
         channel.starts_with("S2.") || channel.starts_with("S3.") || measures_spectrum(channel);
}

}  // namespace

Image denoising_guides(const Job& job, int samples, int threads) {
  const Ref<ImageBuffer> image = make<ImageBuffer>();
  image->width = job.image->width;
  image->height = job.image->height;
  image->crop = job.image->crop;
  image->filter = ref_cast<Filter>(Registry::instance().create("BoxFilter"));
  image->layers = {"albedo", "normal"};
  prepare_tree(*image);
  const RenderContext context{*job.scene, *job.camera, *image, *job.wavelengths, job.seed};
  Film unseen(*image);
  const std::atomic<bool> never{false};
  ParallelSchedule schedule(unseen, threads, never);
  SurfaceFilm film(*image);
  film.take(surfaces_of_step(schedule, context, *job.renderer, {0, {0, std::uint32_t(samples)}}, [&](SurfaceTile&) {
    return [&](const Ray& ray, const CameraSample&, SampleContext& sample) { return guide_of(context, ray, sample); };
  }));
  film.end_step();
  Image guides(image->area().width(), image->area().height(), {});
  film.snapshot()->add_channels(guides);
  return guides;
}

Image denoised(const Denoiser& denoiser, const Job& job, const Image& picture, int threads) {
  const Image guides = denoiser.guide_samples > 0 ? denoising_guides(job, denoiser.guide_samples, threads)
                                                  : Image(picture.width, picture.height, {});
  const Image whole = denoiser.denoised(picture, guides, threads);

  std::vector<size_t> kept;
  std::vector<std::string> names;
  for (size_t c = 0; c < whole.channels.size(); ++c)
    if (!tells_of_noise(whole.channels[c])) {
      kept.push_back(c);
      names.push_back(whole.channels[c]);
    }
  Image image(whole.width, whole.height, std::move(names));
  size_t at = 0;
  for (size_t i = 0; i < whole.values.size(); i += whole.channels.size())
    for (const size_t c : kept) image.values[at++] = whole.values[i + c];
  image.metadata = whole.metadata;
  image.metadata["denoiser"] = denoiser.class_info().name + ", " + denoiser.worker();
  std::string& bias = image.metadata["bias"];
  bias += (bias.empty() ? "" : "; ") + std::string("denoised: what looked like noise is smoothed");
  return image;
}

std::vector<Ref<Output>> with_denoising(const std::vector<Ref<Output>>& outputs) {
  std::vector<Ref<Output>> all;
  Ref<Denoiser> shared;
  for (const Ref<Output>& output : outputs) {
    all.push_back(output);
    if (!output || dynamic_cast<const DenoisedOutput*>(output.get())) continue;
    const Ref<DenoisedOutput> wrapped = make<DenoisedOutput>();
    if (!shared) shared = wrapped->denoiser;
    wrapped->denoiser = shared;
    wrapped->output = ref_cast<Output>(copy(*output));
    wrapped->file = std::exchange(wrapped->output->file, {});
    wrapped->tone_map = std::exchange(wrapped->output->tone_map, {});
    all.back() = wrapped;
  }
  return all;
}

namespace {

template <class Use>
void for_denoised(const std::vector<Ref<Output>>& outputs, const Use& use) {
  for (const Ref<Output>& output : outputs)
    if (const auto* denoised = dynamic_cast<const DenoisedOutput*>(output.get())) use(*denoised);
}

}  // namespace

std::vector<std::string> denoised_paths(const std::vector<Ref<Output>>& outputs, const std::string& stem) {
  std::vector<std::string> paths;
  for_denoised(outputs, [&](const DenoisedOutput& o) { paths.push_back(DenoisedOutput::denoised_path(o.path(stem))); });
  return paths;
}

void require_denoisers(const std::vector<Ref<Output>>& outputs) {
  for_denoised(outputs, [](const DenoisedOutput& o) {
    if (!o.denoiser) return;  // preparing reports it
    try {
      o.denoiser->require();
    } catch (const Error& error) {
      if (error.location.known()) throw;
      throw Error(error.what(), o.location_of("denoiser"));
    }
  });
}

void warn_of_wide_filter(const Job& job, const std::vector<Ref<Output>>& outputs) {
  constexpr float own_pixel = 0.5f;
  if (denoised_paths(outputs, "").empty() || job.image->filter->radius() <= own_pixel) return;
  warn(
      "noise will stay in the denoised picture: the filter spreads each sample over several pixels, and a denoiser cannot tell "
      "this correlated noise from detail. Render with 'filter: BoxFilter {}'",
      job.image->location_of("filter"));
}

std::vector<std::string> write_denoised(const Job& job, const std::vector<Ref<Output>>& outputs, const Image& picture,
                                        const std::string& stem, int threads, std::vector<Error>& errors) {
  std::map<const Denoiser*, Image> made;
  std::vector<std::string> written;
  for_denoised(outputs, [&](const DenoisedOutput& output) {
    try {
      const Denoiser& denoiser = *output.denoiser;
      if (!made.contains(&denoiser)) made.emplace(&denoiser, denoised(denoiser, job, picture, threads));
      const std::string path = DenoisedOutput::denoised_path(output.path(stem));
      const ToneMap* tone = tone_map_of(job, output);
      const Image& second = made.at(&denoiser);
      output.write_image(tone ? tone->apply(second) : second, path);
      written.push_back(path);
    } catch (const Error& error) {
      errors.push_back(error);
    }
  });
  return written;
}

}  // namespace etendue
