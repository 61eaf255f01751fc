#include "display_tone_map.h"

namespace etendue {

Ref<ToneMap> display_tone_map(const Job& job) {
  if (job.tone_map && job.tone_map->clips()) return job.tone_map;
  Ref<ToneMap> map = make<Job>()->tone_map;
  prepare_tree(*map);
  return map;
}

}  // namespace etendue
