#include "etendue/transport/light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "film/picture_format.h"

namespace etendue {
namespace {

/// The names by which a luminaire can be in a group: that of its object, and that of its emission.
std::vector<std::string> names_of(const SceneObject& luminaire) {
  std::vector<std::string> names;
  for (const Component* part :
       {static_cast<const Component*>(&luminaire.original()), static_cast<const Component*>(luminaire.emission.get())})
    if (part && part->origin && !part->origin->name.empty()) names.push_back(part->origin->name);
  return names;
}

std::string trimmed(std::string_view s) {
  const size_t first = s.find_first_not_of(' '), last = s.find_last_not_of(' ');
  return first == s.npos ? std::string() : std::string(s.substr(first, last - first + 1));
}

/// The names of luminaires in the name of a group: one, or several separated by '+'.
std::vector<std::string> names_in(const std::string& group, const std::set<std::string>& known) {
  if (known.contains(group)) return {group};
  std::vector<std::string> names;
  for (size_t begin = 0; begin <= group.size();) {
    const size_t end = std::min(group.find('+', begin), group.size());
    names.push_back(trimmed(std::string_view(group).substr(begin, end - begin)));
    begin = end + 1;
  }
  return names;
}

[[noreturn]] void refuse(const ImageBuffer& image, const std::string& name, const std::set<std::string>& known) {
  if (known.empty())
    image.fail("layers",
               fmt::format("no luminaire is called '{}': none has a name, as 'lamp' has in 'lamp = Sphere {{ … }}'", name));
  const std::vector<std::string> all(known.begin(), known.end());
  image.fail("layers", fmt::format("no luminaire and no emission is called '{}'{}", name, suggestion(name, all)));
}

}  // namespace

LightGroups::LightGroups(const Scene& scene, const ImageBuffer& image)
    : stokes_(image.format()->stokes), paths_(std::make_shared<const PathLayers>(scene, image)) {
  const std::vector<std::string>& wanted = image.format()->light_groups;
  if (wanted.empty()) return;
  count_ = int(wanted.size());
  std::set<std::string> known;
  for (const SceneObject* luminaire : scene.luminaires())
    for (std::string& name : names_of(*luminaire)) known.insert(std::move(name));
  std::map<std::string, int> group_of;
  for (int group = 0; group + 1 < count_; ++group)
    for (const std::string& name : names_in(wanted[size_t(group)], known)) {
      if (!known.contains(name)) refuse(image, name, known);
      group_of.emplace(name, group);  // of several groups the first
    }
  for (const SceneObject* luminaire : scene.luminaires()) {
    int group = count_ - 1;
    for (const std::string& name : names_of(*luminaire))
      if (const auto found = group_of.find(name); found != group_of.end()) group = std::min(group, found->second);
    group_.push_back(std::uint8_t(group));
  }
}

thread_local constinit LightParts* LightParts::collecting_ = nullptr;

LightParts::LightParts(const ImageBuffer& image, const LightGroups& groups)
    : groups_(groups), lengths_(size_t(image.path_lengths)), states_(&groups.paths()), before_(collecting_) {
  // report_light only calls LightParts::add if lengths are stored, so all other parts need at least one length.
  first_group_ = groups.any() ? std::max<size_t>(lengths_, 1) : lengths_;
  first_expression_ = first_group_ + size_t(groups.count());
  parts_.resize(first_expression_ + groups.paths().count() + (groups.stokes() ? PictureFormat::stokes_parts : 0));
  collecting_ = groups.any() ? this : nullptr;
}

LightParts::~LightParts() { collecting_ = before_; }

void LightParts::clear() {
  for (Spectrum& part : parts_) part = {};
  told_ = {};
  labelled_.clear();
  states_.clear();
}

std::span<Spectrum> LightParts::lengths() { return std::span(parts_).first(first_group_); }
std::span<const Spectrum> LightParts::all() const { return std::span(parts_).subspan(first_group_ - lengths_); }

void LightParts::take(const SplatLabel& label, const Spectrum& light) {
  if (keeps_labelled_) labelled_.push_back({label, light});
  if (label.group >= 0) parts_[first_group_ + size_t(label.group)] += light;
  if (label.matches == SplatLabel::unknown) return;
  told_ += light;
  for (std::uint32_t set = label.matches; set; set &= set - 1)
    parts_[first_expression_ + size_t(std::countr_zero(set))] += light;
}

void LightParts::add(int length, const SceneObject* luminaire, const Spectrum& light, PathState matches) {
  if (!collecting_) return;
  each_label(length, luminaire, light, matches,
             [](const SplatLabel& label, const Spectrum& part) { collecting_->take(label, part); });
}

void LightParts::add_stokes(const Spectrum& s1, const Spectrum& s2, const Spectrum& s3) {
  if (!collecting_ || !collecting_->groups_.stokes()) return;
  Spectrum* const sums = collecting_->parts_.data() + (collecting_->parts_.size() - PictureFormat::stokes_parts);
  sums[0] += s1;
  sums[1] += s2;
  sums[2] += s3;
}

void LightParts::add(const Labelled& part) {
  if (collecting_) collecting_->take(part.label, part.light);
}

void LightParts::weigh(const Spectrum& weight) {
  if (!collecting_) return;
  for (size_t i = collecting_->first_group_; i < collecting_->parts_.size(); ++i) collecting_->parts_[i] *= weight;
  collecting_->told_ *= weight;
  for (Labelled& part : collecting_->labelled_) part.light *= weight;
}

void LightParts::require_all(const Spectrum& value, const Wavelengths& wavelengths) const {
  if (groups_.paths().count() == 0) return;
  constexpr float rounding = 1e-3f;
  const int count = wavelengths.single() ? 1 : spectrum_size;  // the others are meaningless
  float apart = 0, most = 0;
  for (int i = 0; i < count; ++i) {
    apart = std::max(apart, std::abs(value[i] - told_[i]));
    most = std::max(most, std::abs(value[i]));
  }
  if (std::isfinite(most) && !(apart <= rounding * most))
    throw Error(
        "this renderer does not tell by which paths its light comes, so that layers by light path expressions ('path.…' of the "
        "image) cannot be kept");
}

}  // namespace etendue
