#pragma once
// RunState: what the nodes of a running group read and write besides the values in memory; and RunServices, the world as the
// library's functions see it during the run.

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "globals.h"
#include "messages.h"
#include "osl/library/services.h"

namespace etendue::osl {

class ShaderGroup;
struct RunState;

/// Answers what the point, the layers and the messages answer, and passes all else to the renderer's services.
class RunServices final : public Services {
 public:
  explicit RunServices(RunState& run) : run_(&run) {}

  bool to_common(const String*, Matrix&) override;
  bool from_common(const String*, Matrix&) override;
  bool unknown_space_is_error() const override;
  float seconds_per_time() const override;
  float seconds_per_frame() const override;
  float metres_per_unit() const override;
  Triple geometric_normal() const override;
  bool backfacing() const override;
  bool ray_type(const String*) const override;
  bool flipped_handedness() const override;
  float surface_area() const override;
  void displace(const Dual<Triple>&, bool bump) override;
  void displace_along_normal(const Dual<float>&, const String* space, bool bump) override;
  bool attribute(const String* object, const String* name, int index, const Type&, bool derivatives, void* out) override;
  void set_message(const String*, const Type&, bool derivatives, const void*, Location) override;
  bool get_message(const String* source, const String* name, const Type&, bool derivatives, void* out, Location) override;
  std::string_view texture(const String*, const Dual<float>&, const Dual<float>&, const TextureOptions&,
                           TextureLookup&) override;
  std::string_view texture3d(const String*, const Dual<Triple>&, const TextureOptions&, TextureLookup&) override;
  std::string_view environment(const String*, const Dual<Triple>&, const TextureOptions&, TextureLookup&) override;
  bool texture_info(const String*, const float* at, const String* name, const Type&, void* out, const char*) override;
  void print(std::string_view) override;
  void print_to(const String*, std::string_view) override;
  void warn(std::string_view, Location) override;
  void error(std::string_view, Location) override;
  const ColorSystem& color_system() const override;
  bool transform_color(const String*, const String*, const Triple&, Triple&) override;
  const Wavelengths& wavelengths() const override;
  bool named_spectrum(const String*, Spectrum&) override;
  Spectrum color_spectrum(const Triple&, bool light) override;
  void* allocate(std::size_t size, std::size_t alignment) override;

 private:
  const char* shader_file() const;
  RunState* run_;
};

struct RunState {
  std::byte* memory = nullptr;  ///< the frame: all values of all layers, see memory_layout.h
  Services* world = nullptr;    ///< the renderer's
  const ShaderGroup* group = nullptr;
  Globals* globals = nullptr;  ///< in the frame
  Messages messages;
  int layer = 0;               ///< which runs now
  bool speaks_itself = false;  ///< a call of error() or warning() runs: the text is the shader's, not a fault
  const std::atomic<bool>* abort = nullptr;
  unsigned steps = 0;  ///< of all loops of this run
  /// A run with more steps of its loops than this is taken for endless: a second of empty steps at the most, for one point.
  static constexpr unsigned most_steps = 10'000'000;
  /// Likewise one that is still in its loops after this time. It ends the render, so no picture depends on the machine's speed.
  static constexpr std::chrono::seconds most_time{10};
  std::chrono::steady_clock::time_point looked_first;  ///< when the loops of this run were first looked at
  RunServices services{*this};

  RunState() = default;
  RunState(const RunState&) = delete;
  RunState& operator=(const RunState&) = delete;

  /// Reports a fault of the shader that is no error of its user's input: an index out of range, for example.
  void fault(std::string_view text, const Location&);
};

}  // namespace etendue::osl
