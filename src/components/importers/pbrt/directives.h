#pragma once
// The directives of pbrt files; each has a function that reads its arguments.

#include <fmt/format.h>

#include "files/regular_file.h"
#include "reader.h"

namespace etendue::pbrt {

/// An open file.
struct Source {
  std::string path, folder;
  std::shared_ptr<FileContents> contents;
  std::unique_ptr<Lexer> lexer;
  bool import = false;  ///< opened by v4's Import: settings are restored at its end
  size_t nested = 0;    ///< number of saved states when the file began
};

/// Reads a file and the files that it includes.
class Directives {
 public:
  explicit Directives(Reader& reader) : r(reader) { r.state.space = &rgb_space("srgb"); }

  void read(std::string_view text);

 private:
  // directives.cpp
  using Handler = void (Directives::*)();
  struct Directive {
    const char* name;
    Handler handler;
  };
  static const std::vector<Directive>& table();
  static Handler handler_of(std::string_view name) {
    for (const Directive& d : table())
      if (name == d.name) return d.handler;
    return nullptr;
  }

  Lexer& lexer();

  void step();

  std::string unknown() const;

  /// A lexer for a text in the syntax of the reader's version; its errors name `path`.
  std::unique_ptr<Lexer> lexer_of(std::string_view text, const std::string& path);

  /// Continues at the next directive after an error, if the text can still be split into tokens.
  void recover(bool lexing);

  void end_source();

  // Read the arguments of a directive.
  template <size_t count>
  std::array<double, count> numbers() {
    const bool list = lexer().peek().is(Token::Kind::open);
    if (list) lexer().next();
    std::array<double, count> all{};
    for (double& n : all) {
      const Token t = lexer().next();
      if (!lexer().number(t, n))
        throw Error(fmt::format("{} needs {} numbers", token_.text, count), t.end() ? at_ : lexer().place(t));
    }
    if (list && !lexer().next().is(Token::Kind::close))
      throw Error(fmt::format("{} needs {} numbers", token_.text, count), at_);
    return all;
  }
  std::string text();
  Parameters parameters(const std::string& type, int target = -1);
  void need_world();
  void need_options();

  // Transforms
  void apply(const Transform& t);
  void put(const std::array<Transform, 2>& to);
  Transform matrix();
  void identity();
  void translate();
  void scale();
  void rotate();
  void look_at();
  void transform();
  void concat_transform();
  void coordinate_system();
  void coordinate_system_transform();
  void transform_times();
  void active_transform();

  // States
  struct Kept {
    State state;
    const char* what;
    Location at;
  };
  void keep(const char* what);
  void give_back(const char* what, bool transform_only);
  void attribute_begin();
  void attribute_end();
  void transform_begin();
  void transform_end();
  void object_begin();
  void object_end();
  void object_instance();
  void reverse_orientation();
  void attribute();

  // Before WorldBegin
  void set(Setting& setting);
  void camera();
  void film();
  void filter();
  void sampler();
  void integrator();
  void without_effect();
  void left_out();
  void option();
  void color_space();
  void world_begin();
  void world_end();

  // The world
  void material();
  void make_named_material();
  void named_material();
  void texture();
  void shape();
  void light_source();
  void area_light_source();
  void make_named_medium();
  void medium_interface();

  void include_file(bool import);
  void include();
  void import();

  Reader& r;
  std::vector<Source> sources_;
  std::vector<Kept> kept_;
  std::map<std::string, std::array<Transform, 2>, std::less<>> named_systems_;
  std::vector<Error> errors_;
  Token token_;
  Location at_;
  size_t included_ = 0;
  bool world_ = false, told_rest_ = false;
};

}  // namespace etendue::pbrt
