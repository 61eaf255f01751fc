// Outputs and importers that are written in Python.

#include <fmt/format.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "etendue/importer.h"
#include "etendue/output.h"
#include "files/whole_file.h"
#include "parts_points.h"

namespace etendue::python {

namespace {

const MethodName extension_name("extension"), for_display_name("for_display"), encode_name("encode"),
    extensions_name("extensions"), read_name("read");

/// Python makes the bytes of the file; it is written here, whole or not at all.
class PythonOutput final : public PartOf<Output> {
 public:
  using PartOf::PartOf;

  std::string extension() const override {
    const Interpreter lock;
    return to_text(attribute_or_call(*this, extension_name), {declared_class().name, extension_name.text});
  }
  bool for_display() const override { return truth_of(*this, for_display_name, false); }
  void write_image(const Image& image, const std::string& path) const override {
    require_writable(path);
    write_whole_file(path, encoded(image));
  }

 private:
  std::string encoded(const Image& image) const {
    const PartCall call(*this, encode_name);
    auto* const copy = new std::vector<double>(image.values);  // Python may change it, and keep it
    const nb::capsule owner(copy, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    const size_t shape[3] = {size_t(image.height), size_t(image.width), image.channels.size()};
    const nb::object pixels = nb::cast(nb::ndarray<nb::numpy, double>(copy->data(), 3, shape, owner), nb::rv_policy::reference);
    nb::list channels;
    for (const std::string& name : image.channels) channels.append(nb::str(name.c_str(), name.size()));
    nb::dict metadata;
    for (const auto& [key, text] : image.metadata) metadata[key.c_str()] = nb::str(text.c_str(), text.size());
    const nb::object returned = call(pixels, nb::tuple(channels), metadata);
    if (!PyBytes_Check(returned.ptr())) call.called.refuse(returned, "the bytes of the file");
    char* data = nullptr;
    Py_ssize_t size = 0;
    PyBytes_AsStringAndSize(returned.ptr(), &data, &size);
    return {data, size_t(size)};
  }
};

/// The argument of an importer's `read`; it can be used within the call only.
struct ImportingView {
  Importing* importing;
  Importing& get() const {
    if (!importing) throw Error("this can be used only within the call of `read` that it was made for");
    return *importing;
  }
};

class PythonImporter final : public PartOf<Importer> {
 public:
  using PartOf::PartOf;

  std::vector<std::string> extensions() const override {
    const Interpreter lock;
    const Called called{declared_class().name, extensions_name.text};
    const nb::object names = attribute_or_call(*this, extensions_name);
    if (!PyTuple_Check(names.ptr()) && !PyList_Check(names.ptr())) called.refuse(names, "a tuple of endings without dots");
    std::vector<std::string> all;
    for (const nb::handle name : names) all.push_back(to_text(name, called));
    return all;
  }

  /// An Error without a place in the file gets the file as its place.
  Ref<Component> import(Importing& importing) const override {
    try {
      importing.contents();  // a missing or damaged file is refused as by all importers
      return read(importing);
    } catch (const Error& e) {
      if (e.location.file == importing.at().file) throw;
      const std::string line = e.location.known() ? fmt::format(" ({}:{})", e.location.file, e.location.line) : "";
      throw Error(e.what() + line, importing.at());
    }
  }

 private:
  Ref<Component> read(Importing& importing) const {
    const PartCall call(*this, read_name);
    const nb::object view = nb::cast(ImportingView{&importing});
    struct Forget {
      ImportingView& view;
      ~Forget() { view.importing = nullptr; }
    } const forget{*nb::inst_ptr<ImportingView>(view)};
    const nb::object returned = call(view);
    if (!is_component(returned)) call.called.refuse(returned, "a Job or a Scene");
    return component_of(returned);
  }
};

}  // namespace

void bind_importing(nb::module_& m) {
  using namespace nb::literals;
  nb::class_<ImportingView>(m, "Importing", "The file that an importer reads, and what it could not express.")
      .def_prop_ro(
          "path", [](const ImportingView& v) { return v.get().path(); }, "The file.")
      .def_prop_ro("strict", [](const ImportingView& v) { return v.get().options().strict; })
      .def_prop_ro(
          "time", [](const ImportingView& v) { return v.get().options().time; }, "[s]")
      .def(
          "contents",
          [](const ImportingView& v, const std::string& path) {
            const Importing& importing = v.get();
            const std::string bytes = released([&] {
              return path.empty() ? importing.contents()
                                  : importing.contents(importing.file(path, importing.at()), importing.at());
            });
            return nb::bytes(bytes.data(), bytes.size());
          },
          "file"_a = "", "All bytes of the file, or of another file that it refers to.")
      .def(
          "file", [](const ImportingView& v, const std::string& named) { return v.get().file(named, v.get().at()); }, "named"_a,
          "The path of a file that the source refers to: beside it, or in the allowed folders.")
      .def(
          "parameter", [](const ImportingView& v, const std::string& name) { return v.get().parameter(name); }, "name"_a,
          "The value that the user gave to a parameter of the source; None: none.")
      .def(
          "inexact", [](const ImportingView& v, const std::string& what, int line) { v.get().inexact(what, v.get().at(line)); },
          "what"_a, "line"_a = 0, "Notes something in the source that cannot be expressed, or only approximately.")
      .def(
          "error",
          [](const ImportingView& v, const std::string& message, int line, int column) {
            throw Error(message, v.get().at(line, column));
          },
          "message"_a, "line"_a = 0, "column"_a = 0, "Raises etendue.Error with the place in the file.");
}

PartInterface output_interface() {
  return {"Output",
          make_part<PythonOutput>,
          {{"extension", "self", "the usual ending, with its dot"},
           {"for_display", "self", "whether it takes R G B for a display; False (X Y Z) by default"},
           {"encode", "self, pixels, channels, metadata",
            "the bytes of the file, from an array of shape (height, width, channels), the channels' names and a dict of texts"},
           prepare_method},
          {{"extension"}, {"encode"}}};
}

PartInterface importer_interface() {
  return {"Importer",
          make_part<PythonImporter>,
          {{"extensions", "self", "the endings that it reads, without dots"},
           {"read", "self, importing",
            "a Job or a Scene; importing.contents, .file, .parameter, .inexact, .error are what reading needs"},
           prepare_method},
          {{"extensions"}, {"read"}}};
}

}  // namespace etendue::python
