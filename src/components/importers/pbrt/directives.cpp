// Reads the directives of a pbrt file in order.

#include <filesystem>

#include "directives.h"

namespace etendue::pbrt {

namespace {
constexpr size_t most_errors = 20;
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

}  // namespace etendue::pbrt
