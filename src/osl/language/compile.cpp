#include "compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "checker.h"
#include "parser.h"
#include "preprocess.h"
#include "source_files.h"

namespace etendue::osl {

namespace {

void compile(const std::string& text, const std::string& name, const CompileOptions& options, Compiled& out,
             Diagnostics& diagnostics) {
  const std::vector<Token> tokens = preprocess(text, name, options, out.files, diagnostics);
  const syntax::File file = parse(tokens, diagnostics);
  std::unique_ptr<Shader> shader = Checker(diagnostics).check(file, name);
  if (!shader) return;
  const std::vector<bool> derivatives = find_derivatives(*shader);
  for (const auto& s : shader->symbols) s->needs_derivatives = derivatives[std::size_t(s->index)];
  out.shader = std::move(shader);
}

}  // namespace

Compiled compile_text(const std::string& text, const std::string& name, const CompileOptions& options) {
  Compiled out;
  Diagnostics diagnostics(options.most_errors);
  try {
    compile(text, name, options, out, diagnostics);
  } catch (const Diagnostics::Stop&) {
  } catch (const std::bad_alloc&) {
    diagnostics.list.push_back({false, {intern(name), 0, 0}, "the memory does not suffice for this shader"});
  }
  if (diagnostics.failed()) out.shader = nullptr;
  out.diagnostics = std::move(diagnostics.list);
  return out;
}

Compiled compile_file(const std::string& path, const CompileOptions& options) {
  std::string text;
  try {
    text = SourceFiles::read(path);
  } catch (const Error& e) {
    Compiled out;
    out.diagnostics.push_back({false, {intern(path), 0, 0}, e.what()});
    return out;
  }
  Compiled out = compile_text(text, path, options);
  out.files.insert(out.files.begin(), path);
  return out;
}

std::string to_text(const std::vector<Diagnostic>& list) {
  std::string text;
  for (const Diagnostic& d : list) {
    text += d.place.file;
    if (d.place.line > 0) text += fmt::format(":{}:{}", d.place.line, d.place.column);
    text += fmt::format(": {}: {}\n", d.warning ? "warning" : "error", d.text);
  }
  return text;
}

}  // namespace etendue::osl
