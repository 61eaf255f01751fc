#pragma once
// The options of `etendue compare`.

#include <array>

#include "app/scene_options.h"
#include "check/compare/runs.h"
#include "check/compare/variants.h"
#include "etendue/film/image_buffer.h"

namespace etendue {

struct CompareOptions : SceneOptions {
  std::vector<std::string> files, variant_texts, references, inset_texts;
  std::string renderers, time, reference_time, report, csv, json, state, seed, size;  ///< as written; empty: not given
  int samples = 0, runs = 8, tile = 0, threads = 0;
  double significance = 0.01;
  bool quiet = false;

  void add_to(Command& command);
  /// Loads a file's job with all overrides.
  Ref<Job> load(const std::string& file) const;
  /// These throw Error for options that contradict each other.
  comparing::Budget budget() const;
  double reference_seconds() const;
  std::vector<comparing::Variant> variants() const;
  std::vector<PixelArea> insets() const;
  /// The folder where runs are stored; empty: none.
  std::string state_folder() const;
  std::string command_line() const;
};

}  // namespace etendue
