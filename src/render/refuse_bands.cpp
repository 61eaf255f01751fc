#include "refuse_bands.h"

#include <unordered_set>

#include "describe/expansion.h"
#include "etendue/describe/bands.h"
#include "etendue/describe/registry.h"
#include "etendue/film/image_buffer.h"
#include "etendue/render/job.h"
#include "film/picture_format.h"

namespace etendue {

namespace {

constexpr const char* advice = ", which RgbWavelengths do not carry: use HeroWavelengths";

/// Each wavelength is refracted into a direction of its own. (A metal, whose index is complex, refracts nothing.)
void refuse_dispersion(const Component& c) {
  for (const Member& m : c.class_info().members) {
    if (m.meaning != Meaning::index || m.kind != Kind::color) continue;
    const Value value = m.get(c, m);
    const Color* const index = value.as<Color>();
    if (!index || !*index || (*index)->imaginary() || !(*index)->varies()) continue;
    const ValueRange range = range_of(**index, ColorUse::coefficient);
    if (range.least < range.most)
      c.fail(m.name, "this index of refraction disperses light into its wavelengths" + std::string(advice) +
                         ", or give the index as a number");
  }
}

void refuse(const Component& c) {
  refuse_dispersion(c);
  const auto* const needs = dynamic_cast<const NeedsWavelengths*>(&c);
  if (!needs) return;
  try {
    needs->refuse_bands();
  } catch (const Error& e) {
    throw Error(e.what() + std::string(advice), e.location.known() ? e.location : c.location_of());
  }
}

}  // namespace

void refuse_bands_where_they_lack(const Job& job) {
  if (!in_bands(job.wavelengths->sample({}, 0))) return;
  if (job.image->format()->bands) job.image->fail({}, "holds spectra of wavelengths" + std::string(advice));
  std::unordered_set<const Component*> seen{&job};
  std::vector<const Component*> left{&job};
  while (!left.empty()) {
    const Component& c = *left.back();
    left.pop_back();
    refuse(c);
    for (const Component* const part : components_of(c))
      if (seen.insert(part).second) left.push_back(part);
  }
}

}  // namespace etendue
