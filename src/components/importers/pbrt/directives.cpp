// Reads the directives of a pbrt file in order.

#include "directives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace etendue::pbrt {

namespace {
constexpr size_t most_errors = 20, most_nested = 100'000, most_included = 10'000, most_deep = 64;
}  // namespace

const std::vector<Directives::Directive>& Directives::table() {
  using D = Directives;
  static const std::vector<Directive> all = {
      {"Shape", &D::shape},
      {"AttributeBegin", &D::attribute_begin},
      {"AttributeEnd", &D::attribute_end},
      {"Translate", &D::translate},
      {"Scale", &D::scale},
      {"Rotate", &D::rotate},
      {"Transform", &D::transform},
      {"ConcatTransform", &D::concat_transform},
      {"Identity", &D::identity},
      {"LookAt", &D::look_at},
      {"CoordinateSystem", &D::coordinate_system},
      {"CoordSysTransform", &D::coordinate_system_transform},
      {"TransformBegin", &D::transform_begin},
      {"TransformEnd", &D::transform_end},
      {"TransformTimes", &D::transform_times},
      {"ActiveTransform", &D::active_transform},
      {"ReverseOrientation", &D::reverse_orientation},
      {"Attribute", &D::attribute},
      {"NamedMaterial", &D::named_material},
      {"Material", &D::material},
      {"MakeNamedMaterial", &D::make_named_material},
      {"Texture", &D::texture},
      {"LightSource", &D::light_source},
      {"AreaLightSource", &D::area_light_source},
      {"MakeNamedMedium", &D::make_named_medium},
      {"MediumInterface", &D::medium_interface},
      {"ObjectInstance", &D::object_instance},
      {"ObjectBegin", &D::object_begin},
      {"ObjectEnd", &D::object_end},
      {"Include", &D::include},
      {"Import", &D::import},
      {"Camera", &D::camera},
      {"Film", &D::film},
      {"PixelFilter", &D::filter},
      {"Filter", &D::filter},
      {"Sampler", &D::sampler},
      {"Integrator", &D::integrator},
      {"SurfaceIntegrator", &D::integrator},
      {"VolumeIntegrator", &D::left_out},
      {"Renderer", &D::left_out},
      {"Accelerator", &D::without_effect},
      {"Option", &D::option},
      {"ColorSpace", &D::color_space},
      {"WorldBegin", &D::world_begin},
      {"WorldEnd", &D::world_end},
  };
  return all;
}

void Directives::read(std::string_view text) {
  Source first;
  first.path = r.importing.path();
  first.folder = std::filesystem::path(first.path).parent_path().string();
  first.lexer = lexer_of(text, first.path);
  sources_.push_back(std::move(first));
  r.materials[0].type = r.version == 4 ? "diffuse" : "matte";
  r.materials[0].parameters.of = "the material that is there when none is given";
  r.materials[0].parameters.at = r.importing.at();
  while (!sources_.empty() && errors_.size() < most_errors) step();
  if (errors_.empty() && !world_) errors_.emplace_back("there is no WorldBegin: the file holds no scene", r.importing.at());
  if (errors_.empty() && !kept_.empty() && r.version == 3)
    r.importing.inexact(fmt::format("this {}Begin has no end", kept_.back().what), kept_.back().at);
  else if (errors_.empty() && !kept_.empty())
    errors_.emplace_back(fmt::format("this {}Begin has no end", kept_.back().what), kept_.back().at);
  if (!errors_.empty()) throw Errors(std::move(errors_));
}

Lexer& Directives::lexer() { return *sources_.back().lexer; }

std::unique_ptr<Lexer> Directives::lexer_of(std::string_view text, const std::string& path) {
  auto made = std::make_unique<Lexer>(text, intern(path));
  if (r.version == 3) made->lenient = &r.importing;
  return made;
}

void Directives::step() {
  bool lexing = true;
  try {
    token_ = lexer().next();
    lexing = false;
    if (token_.end()) {
      end_source();
      return;
    }
    at_ = lexer().place(token_);
    const Handler handler = token_.is(Token::Kind::word) ? handler_of(token_.text) : nullptr;
    if (!handler) throw Error(unknown(), at_);
    (this->*handler)();
  } catch (const LeftOut& e) {
    if (r.version == 3)
      r.importing.inexact(fmt::format("{}: {}, as by version 3 of pbrt", e.what(), e.instead()), e.location);
    else
      errors_.push_back(e);
    recover(lexing);
  } catch (const Error& e) {
    errors_.push_back(e.location.known() ? e : Error(e.what(), at_));
    recover(lexing);
  } catch (const Errors& e) {
    errors_.insert(errors_.end(), e.errors.begin(), e.errors.end());
    recover(lexing);
  }
}

std::string Directives::unknown() const {
  std::vector<std::string> known;
  for (const Directive& d : table()) known.emplace_back(d.name);
  const std::string given(token_.text.substr(0, 60));
  return fmt::format("there is no directive '{}'{}", given, suggestion(given, known));
}

void Directives::recover(bool lexing) {
  try {
    while (!lexing) {
      const Token& next = lexer().peek();
      if (next.end() || (next.is(Token::Kind::word) && handler_of(next.text))) return;
      lexer().next();
    }
  } catch (const Error&) {
    lexing = true;
  }
  if (lexing) sources_.clear();
}

void Directives::end_source() {
  const bool import = sources_.back().import;
  const size_t nested = sources_.back().nested;
  sources_.pop_back();
  if (!import) return;
  if (kept_.size() != nested + 1) throw Error("the imported file ends within something it began", at_);
  r.state = std::move(kept_.back().state);
  kept_.pop_back();
}

std::string Directives::text() {
  const Token t = lexer().next();
  if (!t.is(Token::Kind::string))
    throw Error(fmt::format("{} needs a text in quotes", token_.text), t.end() ? at_ : lexer().place(t));
  return Lexer::unescaped(t.text);
}

Parameters Directives::parameters(const std::string& type, int target) {
  Parameters p = Parameters::read(lexer(), fmt::format("{} \"{}\"", token_.text, type), at_);
  p.folder = sources_.back().folder;
  p.space = r.state.space;
  if (target >= 0) p.defaults = r.state.defaults[size_t(target)];
  return p;
}

void Directives::need_world() {
  if (!world_) throw LeftOut(fmt::format("{} must stand after WorldBegin", token_.text), at_);
}

void Directives::need_options() {
  if (world_) throw LeftOut(fmt::format("{} must stand before WorldBegin", token_.text), at_);
}

void read_directives(Reader& reader, std::string_view text) { Directives(reader).read(text); }

// ---- directives that save and restore the state: attributes, objects, included files -------------------------------

void Directives::keep(const char* what) {
  if (kept_.size() >= most_nested) throw Error(fmt::format("states nest more than {} deep", most_nested), at_);
  kept_.push_back({r.state, what, at_});
}

void Directives::give_back(const char* what, bool transform_only) {
  if (kept_.empty() || (sources_.size() > 1 && sources_.back().import && kept_.size() <= sources_.back().nested + 1))
    throw LeftOut(fmt::format("{}End without {}Begin", what, what), at_);
  if (std::string_view(kept_.back().what) != what)
    throw Error(fmt::format("{}End ends the {}Begin of line {}", what, kept_.back().what, kept_.back().at.line), at_);
  if (transform_only) {
    r.state.ctm = kept_.back().state.ctm;
    r.state.active = kept_.back().state.active;
  } else {
    r.state = std::move(kept_.back().state);
  }
  kept_.pop_back();
}

void Directives::attribute_begin() { keep("Attribute"); }

void Directives::attribute_end() { give_back("Attribute", false); }

void Directives::transform_begin() { keep("Transform"); }

void Directives::transform_end() { give_back("Transform", true); }

void Directives::object_begin() {
  need_world();
  r.begin_object(text(), at_);
  keep("Object");
}

void Directives::object_end() {
  give_back("Object", false);
  r.end_object(at_);
}

void Directives::object_instance() {
  need_world();
  r.instance(text(), at_);
}

void Directives::reverse_orientation() { r.state.reversed = !r.state.reversed; }

void Directives::attribute() {
  const std::string target = text();
  const auto found = std::ranges::find(attribute_targets, target);
  if (found == attribute_targets.end())
    throw Error(fmt::format("Attribute is of shape, light, material, medium or texture, not '{}'", target), at_);
  Parameters p = parameters(target);
  auto& list = r.state.defaults[size_t(found - attribute_targets.begin())];
  // Newest first, because lookups return the first match; older parameters of the same name and type are dropped.
  if (list) {
    const size_t fresh = p.own.size();
    for (const Parameter& old : *list)
      if (std::ranges::none_of(p.own.begin(), p.own.begin() + std::ptrdiff_t(fresh),
                               [&](const Parameter& q) { return q.name == old.name && q.type == old.type; }))
        p.own.push_back(old);
  }
  constexpr size_t most = 200;  // each following shape, light, … searches the list
  if (p.own.size() > most) throw Error(fmt::format("more than {} attributes are given to every {}", most, target), at_);
  list = std::make_shared<const std::vector<Parameter>>(std::move(p.own));
}

void Directives::include_file(bool import) {
  const Token named = lexer().peek();
  const std::string name = text();
  const Location at = lexer().place(named);
  if (sources_.size() >= most_deep) throw Error(fmt::format("files include each other more than {} deep", most_deep), at);
  if (++included_ > most_included) throw Error(fmt::format("more than {} files are included", most_included), at);
  Source source;
  source.path = r.importing.file(name, at, sources_.back().folder);
  std::error_code error;
  for (const Source& outer : sources_)
    if (std::filesystem::equivalent(outer.path, source.path, error)) throw Error(fmt::format("'{}' includes itself", name), at);
  source.folder = std::filesystem::path(source.path).parent_path().string();
  try {
    source.contents = std::make_shared<FileContents>(source.path);
  } catch (const Error& e) {
    throw Error(fmt::format("cannot read '{}': {}", name, e.what()), at);
  }
  source.lexer = lexer_of(source.contents->text(), source.path);
  source.import = import;
  source.nested = kept_.size();
  if (import) keep("Import");
  sources_.push_back(std::move(source));
}

void Directives::include() { include_file(false); }

void Directives::import() {
  need_world();
  include_file(true);
}

// ---- transforms, named coordinate systems, and the two times of motion ---------------------------------------------

void Directives::apply(const Transform& t) {
  for (size_t i = 0; i < 2; ++i)
    if (r.state.active & (1u << i)) r.state.ctm[i] = r.state.ctm[i] * t;
}

void Directives::put(const std::array<Transform, 2>& to) {
  for (size_t i = 0; i < 2; ++i)
    if (r.state.active & (1u << i)) r.state.ctm[i] = to[i];
}

Transform Directives::matrix() {
  const auto m = numbers<16>();
  // Column-major. The last row should be (0, 0, 0, 1); it does not affect directions, and so not the lights at infinity.
  if (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) > 1e-9 * std::abs(m[15]) || m[15] == 0)
    r.importing.inexact("the last row of a matrix, which makes a perspective, is left out: for directions nothing is changed",
                        at_);
  const double w = m[15] == 0 ? 1 : m[15];
  Transform::DoubleMatrix rows{m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10], m[14]};
  for (double& x : rows) x /= w;
  return Transform(rows);
}

void Directives::identity() { put({}); }

void Directives::translate() {
  const auto n = numbers<3>();
  apply(Transform::translate({n[0], n[1], n[2]}));
}

void Directives::scale() {
  const auto n = numbers<3>();
  apply(Transform::scale({n[0], n[1], n[2]}));
}

void Directives::rotate() {
  const auto n = numbers<4>();
  if (n[1] == 0 && n[2] == 0 && n[3] == 0) throw Error("an axis of rotation cannot be zero", at_);
  apply(Transform::rotate(n[0] * 3.14159265358979323846 / 180, {n[1], n[2], n[3]}));
}

void Directives::look_at() {
  const auto n = numbers<9>();
  const DoubleVector3 way{n[3] - n[0], n[4] - n[1], n[5] - n[2]}, up{n[6], n[7], n[8]}, side = cross(up, way);
  const auto length = [](const DoubleVector3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); };
  if (!(length(side) > 1e-12 * length(up) * length(way)))
    throw Error("LookAt needs two different points and an up direction that is not along the view", at_);
  // The same matrix as in this program, although pbrt's +x points to the right in the image and ours to the left.
  apply(Transform::look_at({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, up).inverse());
}

void Directives::transform() {
  const Transform t = matrix();
  put({t, t});
}

void Directives::concat_transform() { apply(matrix()); }

void Directives::coordinate_system() { named_systems_[text()] = r.state.ctm; }

void Directives::coordinate_system_transform() {
  const std::string name = text();
  const auto found = named_systems_.find(name);
  if (found != named_systems_.end())
    put(found->second);
  else
    r.importing.inexact(fmt::format("there is no coordinate system '{}': the transform stays what it is, as in pbrt", name),
                        at_);
}

void Directives::transform_times() {
  need_options();
  const auto n = numbers<2>();
  r.times = n;
}

void Directives::active_transform() {
  const Token t = lexer().next();
  const std::string_view which = t.text;
  if (which == "StartTime")
    r.state.active = 1;
  else if (which == "EndTime")
    r.state.active = 2;
  else if (which == "All")
    r.state.active = 3;
  else
    throw Error("ActiveTransform is of StartTime, EndTime or All", t.end() ? at_ : lexer().place(t));
}

// ---- directives before WorldBegin ----------------------------------------------------------------------------------

void Directives::set(Setting& setting) {
  need_options();
  if (setting.given) r.importing.inexact(fmt::format("{} is given again: the last one counts", token_.text), at_);
  setting.type = text();
  setting.parameters = parameters(setting.type);
  setting.given = true;
}

void Directives::camera() {
  set(r.camera);
  std::array<Transform, 2> inverse;
  if (!r.state.ctm[0].valid() || !r.state.ctm[1].valid())
    throw Error("the camera cannot be placed: its transform cannot be inverted", at_);
  for (size_t i = 0; i < 2; ++i) inverse[i] = r.state.ctm[i].inverse();
  named_systems_["camera"] = inverse;
  std::swap(r.state.ctm, inverse);
  r.camera_to_world = r.to_world(Transform());
  std::swap(r.state.ctm, inverse);
  r.around_camera = r.state.outside;
  r.around_camera_at = at_;
}

void Directives::film() { set(r.film); }

void Directives::filter() { set(r.filter); }

void Directives::sampler() { set(r.sampler); }

void Directives::integrator() { set(r.integrator); }

void Directives::without_effect() {
  // Accelerators: they do not change the image.
  const std::string type = text();
  parameters(type).forget();
}

void Directives::left_out() {
  const std::string type = text();
  parameters(type).forget();
  r.importing.inexact(fmt::format("{} \"{}\" is of an older pbrt, and left out", token_.text, type), at_);
}

void Directives::option() {
  need_options();
  const Parameters p = Parameters::read(lexer(), "Option", at_);
  for (const Parameter& o : p.own)
    if (o.name == "seed")
      r.seed = p.integer("seed", 0);
    else if (o.name != "rendercoordsys" && o.name != "msereferenceimage" && o.name != "msereferenceout")
      r.importing.inexact(fmt::format("the option '{}' is left out", o.name), o.at);
}

void Directives::color_space() {
  const std::string name = text();
  const std::pair<const char*, const char*> spaces[] = {
      {"srgb", "srgb"}, {"rec2020", "rec2020"}, {"aces2065-1", "aces2065-1"}, {"dci-p3", "display_p3"}};
  for (const auto& [pbrt, ours] : spaces)
    if (name == pbrt) {
      r.state.space = &rgb_space(ours);
      return;
    }
  throw Error(
      fmt::format("there is no colour space '{}'{}", name, suggestion(name, {"srgb", "rec2020", "aces2065-1", "dci-p3"})), at_);
}

void Directives::world_begin() {
  need_options();
  world_ = true;
  r.state.ctm = {};
  r.state.active = 3;
  named_systems_["world"] = r.state.ctm;
  r.exposure = imaging_ratio(r);
}

void Directives::world_end() {
  need_world();
  // The rest is ignored: v3 would read it as another scene.
  while (!lexer().peek().end()) {
    const Token t = lexer().next();
    if (!told_rest_) r.importing.inexact("what stands after WorldEnd is left out", lexer().place(t));
    told_rest_ = true;
  }
}

// ---- directives for materials, textures, shapes, lights and media --------------------------------------------------

void Directives::material() {
  Material m;
  m.type = text();
  m.parameters = parameters(m.type, 2);
  r.state.material = r.materials.size();
  r.state.named_material.clear();
  r.materials.push_back(std::move(m));
  if (r.version == 3) make_with_present_textures(r, r.state.material);
}

void Directives::make_named_material() {
  Material m;
  m.name = text();
  m.parameters = parameters(m.name, 2);
  m.type = m.parameters.text("type");
  if (m.type.empty()) throw Error(fmt::format("the material '{}' needs its \"string type\"", m.name), at_);
  const size_t index = r.named_materials[m.name] = r.materials.size();
  r.materials.push_back(std::move(m));
  if (r.version == 3) make_with_present_textures(r, index);
}

void Directives::named_material() {
  const std::string before = std::exchange(r.state.named_material, text());
  // In v3 the name may be given to another material later; in v4 the material may be defined later.
  if (const auto found = r.named_materials.find(r.state.named_material); found != r.named_materials.end()) {
    r.state.material = found->second;
    if (r.version == 3) r.state.named_material.clear();
  } else if (r.version == 3) {
    const std::string name = std::exchange(r.state.named_material, before);
    throw LeftOut(fmt::format("there is no material named '{}'", name), at_, "the one before stays");
  }
}

void Directives::texture() {
  const std::string name = text(), kind = text(), type = text();
  make_texture(r, name, kind, type, parameters(type, 4));
}

void Directives::shape() {
  need_world();
  const std::string type = text();
  r.shape(type, parameters(type, 0));
}

void Directives::light_source() {
  need_world();
  const std::string type = text();
  Parameters p = parameters(type, 1);
  make_light(r, type, std::move(p));
}

void Directives::area_light_source() {
  auto light = std::make_shared<AreaLight>();
  light->type = text();
  light->parameters = parameters(light->type, 1);
  r.state.light = nullptr;
  if (light->type != "diffuse" && light->type != "area")
    throw LeftOut(fmt::format("there is no area light '{}', but 'diffuse'", light->type), at_);
  r.state.light = std::move(light);
}

void Directives::make_named_medium() {
  const std::string name = text();
  make_medium(r, name, parameters(name, 3));
}

void Directives::medium_interface() {
  r.state.inside = r.state.outside = text();
  if (lexer().peek().is(Token::Kind::string)) r.state.outside = text();
}

}  // namespace etendue::pbrt
