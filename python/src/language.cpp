// Files of the language and of other programs: loading, writing, paths of members.

#include "binding.h"

#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "etendue/language/language.h"
#include "etendue/render/job.h"
#include "language/json.h"
#include "live_render.h"
#include "saving/save_job.h"

namespace etendue::python {

namespace {

/// The options of `load` and `loads`, by keyword.
LoadOptions load_options(const std::map<std::string, std::string>& defines, bool allow_files, bool strict,
                         const std::vector<std::string>& allowed_folders, double frame, double time) {
  LoadOptions o;
  o.defines.assign(defines.begin(), defines.end());
  o.allow_files = allow_files;
  o.import = {strict, allowed_folders, time};
  o.frame = frame;
  o.time = time;
  return o;
}

}  // namespace

void bind_language(nb::module_& m) {
  using namespace nb::literals;
  m.def("load", [](const std::string& path, const std::map<std::string, std::string>& defines, bool allow_files, bool strict,
                   const std::vector<std::string>& allowed_folders, double frame, double time) {
    const LoadOptions o = load_options(defines, allow_files, strict, allowed_folders, frame, time);
    return wrap(released([&] { return Ref<Component>(load_job(path, o)); }));
  });
  m.def("loads", [](const std::string& text, const std::string& name, const std::string& folder,
                    const std::map<std::string, std::string>& defines, bool allow_files, double frame, double time) {
    const LoadOptions o = load_options(defines, allow_files, false, {}, frame, time);
    return wrap(released([&] { return Ref<Component>(load_job_text(text, name, folder, o)); }));
  });
  m.def("parse_component", [](const std::string& text, const std::string& name, const std::string& folder) {
    return wrap(released([&] { return parse_component(text, name, folder); }));
  });
  m.def("write_description", [](nb::handle c, bool all, const std::string& folder) {
    const Ref<Component> component = component_of(c);
    return reading(*component, [&] { return write_description(*component, all, folder); });
  });
  m.def("write_json", [](nb::handle c, bool all, const std::string& folder) {
    const Ref<Component> component = component_of(c);
    return reading(*component, [&] { return write_json(*component, all, folder); });
  });
  m.def("save", [](nb::handle job, const std::string& file, bool all, bool strict) {
    const Ref<Job> saved = component_as<Job>(job, "a Job");
    const Location at = calling_line();
    reading(*saved, [&] {
      if (file.ends_with(".etd") || language::is_json(file))
        save_description(*saved, file, "", all, at);
      else
        export_job(*saved, file, strict, at);
    });
  });
}

}  // namespace etendue::python
