#pragma once
// Job: all parts of a render, as they are described. A Render (render.h) runs it.

#include <map>
#include <string>
#include <vector>

#include "etendue/camera.h"
#include "etendue/film/image_buffer.h"
#include "etendue/language/language.h"
#include "etendue/output.h"
#include "etendue/render/renderer.h"
#include "etendue/scene.h"
#include "etendue/tone_map.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {

class Job final : public Component {
 public:
  using Interface = Job;
  using Parent = Component;
  static void describe(Description<Job>&);
  Job();
  ~Job() override;

  Ref<Renderer> renderer;
  Ref<Camera> camera;
  Ref<Scene> scene;
  Ref<ImageBuffer> image;
  Ref<WavelengthSampler> wavelengths;
  Ref<ToneMap> tone_map;
  std::vector<Ref<Output>> outputs;
  std::uint64_t seed = 0;
  double time_limit = 0;   ///< [s]; 0: none
  double error_limit = 0;  ///< relative standard error; 0: none

  /// Texts that pictures carry, besides what is said of every one ("file_hash", …). Not described.
  std::map<std::string, std::string> metadata;

  void before_prepare() override;
  void prepare() override;
  void prepare_again() override;

  /// The point of the world that rendering coordinates count from, once it is prepared.
  const DoublePoint3& world_centre() const { return centre_; }
  /// Whether preparing it anew would have the scene count from another point: the camera or the time was moved too far.
  bool centre_is_stale() const;
  /// Whether that point was found from the camera alone; else it is the middle of a scene that is far from the camera.
  bool counts_from_camera() const { return centre_ == viewpoint_; }

 private:
  void require_parts() const;
  void count_from(const DoublePoint3& centre);
  DoublePoint3 viewpoint() const;

  DoublePoint3 viewpoint_, centre_;
  float opened_ = 0;  // the time at which the shutter opens, for which the scene counts from there [s]
};

/// Reads a render description, or a file of another program that an Importer knows by its ending, whose differences are warned
/// of; throws Errors with everything wrong that can be found in one run. Not prepared yet.
Ref<Job> load_job(const std::string& path, const LoadOptions& = {});
/// The same from a text; `name` stands for the file in messages, paths are relative to `folder`.
Ref<Job> load_job_text(const std::string& text, const std::string& name, const std::string& folder = {},
                       const LoadOptions& = {});

}  // namespace etendue
