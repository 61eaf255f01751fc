#pragma once
// Job: the description of a whole render: renderer, camera, scene, film, outputs. A Render (render.h) runs it.

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
#include "etendue/transport/object_groups.h"
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

  /// Entries that are written into the pictures' metadata, besides those that every picture has ("file_hash", …). Not a
  /// described member.
  std::map<std::string, std::string> metadata;

  std::vector<Ref<ObjectGroup>> groups;  ///< objects under one name, for mattes

  void before_prepare() override;
  void prepare() override;
  void prepare_again() override;

  /// The origin of rendering space, in world space. Valid once the job is prepared.
  const DoublePoint3& rendering_origin() const { return rendering_origin_; }
  /// Whether preparing the job anew would choose another origin, because the camera or the time was moved too far.
  bool rendering_origin_is_stale() const;
  /// Whether the origin was chosen from the camera alone; otherwise it is the centre of a scene that is far from the camera.
  bool origin_is_near_camera() const { return rendering_origin_ == viewpoint_; }

 private:
  void require_parts() const;
  void require_layers() const;
  void set_rendering_origin(const DoublePoint3&);
  DoublePoint3 viewpoint() const;

  DoublePoint3 viewpoint_, rendering_origin_;
  float opened_ = 0;  // the time at which the shutter opens, for which the origin of the scene was chosen [s]
};

/// Reads a render description, or a file of another program for whose extension there is an Importer; warns of what the
/// importer could not represent exactly. Throws Errors with all errors that one run can find. The job is not prepared yet.
Ref<Job> load_job(const std::string& path, const LoadOptions& = {});
/// The same from a text; `name` stands for the file in messages, paths are relative to `folder`.
Ref<Job> load_job_text(const std::string& text, const std::string& name, const std::string& folder = {},
                       const LoadOptions& = {});

}  // namespace etendue
