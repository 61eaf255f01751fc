#include "etendue/render/virtual_lights.h"

namespace etendue {

VirtualLights VirtualLightProcess::make_lights(Schedule& schedule, const Step& step, std::uint64_t walks) const {
  constexpr std::uint64_t item_size = 256;
  const std::uint64_t items = (walks + item_size - 1) / item_size;
  // The path from a virtual light to the camera has at least two more segments: to the camera's vertex, and from there to the
  // camera.
  const SubpathLimits limits{settings_.max_depth - 2, settings_.roulette_depth};
  const LightGroups groups(context.scene, context.image);
  VirtualLights made;
  made.walks = double(walks);
  if (limits.longest < 1) return made;
  for (std::uint64_t i = 0; i < items; ++i) made.memory.push_back(std::make_unique<Arena>());
  made.lights =
      schedule.collect_everywhere<VirtualLight>(items, [&](std::uint64_t item, std::vector<VirtualLight>& lights, Arena&) {
        Arena& arena = *made.memory[size_t(item)];
        std::vector<SubpathVertex> walk;
        EmittedLight light;
        PathStates states(&groups.paths());
        for (std::uint64_t n = item * item_size; n < std::min(walks, (item + 1) * item_size) && !schedule.aborted(); ++n) {
          states.clear();
          Wavelengths& w = *arena.make<Wavelengths>(wavelengths({}, 0));
          const NumberStream numbers(*renderer.sampler, SampleKey(context.seed, -6, int(step.number), std::uint32_t(n)));
          SampleContext sample{w, numbers, arena, {.abort = schedule.abort}};
          if (!generate_light_subpath(context.scene, *renderer.light_sampler, time(0), limits, sample, walk, light)) continue;
          for (size_t i = 1; i < walk.size(); ++i)
            if (walk[i].connectable()) {
              const VirtualLight whole{walk[i], int(i) + 1, walk[0].point.object};
              if (PathStates::current() != &states) {
                lights.push_back(whole);
                continue;
              }
              states.each(walk[i - 1].path, whole.at.throughput, [&](std::uint32_t state, const Spectrum& part) {
                lights.push_back(whole);
                lights.back().at.throughput = part;
                lights.back().rest = {state};
              });
            }
        }
      });
  return made;
}

}  // namespace etendue
