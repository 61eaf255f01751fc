// Shaders that are written in Python. Their methods are those of ScatterModel (etendue/scatter_model.h), in local directions.

#include <fmt/format.h>

#include "etendue/scatter_model.h"
#include "parts_points.h"

namespace etendue::python {

namespace {

const MethodName evaluate_name("evaluate"), pdf_name("pdf"), sample_name("sample"), albedo_name("albedo"), lobes_name("lobes"),
    interior_index_name("interior_index"), relative_index_name("relative_index"), reciprocal_name("reciprocal"),
    lossless_name("lossless"), albedo_error_name("albedo_error");

/// The Python objects of the point and the wavelengths of the Scatter that this thread called last: its functions are called
/// one after the other, and making the objects takes as long as a call. Freed never, as a thread may end after the interpreter.
struct LastBound {
  std::uint64_t number = 0;
  PyObject *point = nullptr, *wavelengths = nullptr;
};
thread_local LastBound last;
thread_local std::uint64_t bound_count = 0;

class PythonShader;

class PythonScatter final : public ScatterModel<PythonScatter> {
 public:
  PythonScatter(const PythonShader& shader, const SurfacePoint& p, const Wavelengths& w, Lobes lobes)
      : ScatterModel(p, lobes), shader_(shader), point_(p), wavelengths_(w), number_(++bound_count) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const;
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const;
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes, LocalSample&) const;
  Spectrum local_albedo(const Vector3& out, Lobes) const;
  Spectrum relative_index(const Vector3& out, const Vector3& in) const;
  bool reciprocal() const;

 private:
  /// Calls a method with the point, the wavelengths and further arguments.
  template <class... A>
  nb::object ask(const PartCall& call, const A&... arguments) const;

  const PythonShader& shader_;
  SurfacePoint point_;
  Wavelengths wavelengths_;
  std::uint64_t number_;  // of this object on its thread
};
static_assert(std::is_trivially_destructible_v<PythonScatter>);

class PythonShader final : public PartOf<Shader> {
 public:
  using PartOf::PartOf;

  void prepare() override {
    PartOf::prepare();
    read_declarations();
  }
  void prepare_again() override { prepare(); }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    return arena.make<PythonScatter>(*this, p, w, possible_lobes());
  }
  /// Constant after `prepare`; before, the class is asked.
  Lobes possible_lobes() const override { return prepared_ ? lobes_ : read_lobes(); }
  Spectrum interior_index(const Wavelengths& w) const override {
    if (!defines(interior_index_name)) return Spectrum(1.0f);
    const PartCall call(*this, interior_index_name);
    return to_spectrum(call(wavelengths_object(w)), call.called);
  }
  bool reciprocal() const override { return prepared_ ? reciprocal_ : truth_of(*this, reciprocal_name, true); }
  bool lossless() const override { return truth_of(*this, lossless_name, false); }
  float albedo_error() const override { return number_of(*this, albedo_error_name, 0); }

  static nb::object wavelengths_object(const Wavelengths& w) {
    std::array<float, spectrum_size> lambda;
    for (int i = 0; i < spectrum_size; ++i) lambda[size_t(i)] = w[i];
    return tuple_of_numbers(lambda);
  }

 private:
  void read_declarations() {
    prepared_ = false;
    lobes_ = read_lobes();
    reciprocal_ = truth_of(*this, reciprocal_name, true);
    prepared_ = true;
  }
  Lobes read_lobes() const {
    const Interpreter lock;
    const Called called{declared_class().name, lobes_name.text};
    const nb::object value = attribute_or_call(*this, lobes_name);
    const double bits = nb::isinstance<nb::int_>(value) ? to_number(value, called) : -1;
    if (!(bits >= 0 && bits <= all_lobes)) called.refuse(value, "lobes, such as etendue.Lobe.diffuse_reflection");
    return Lobes(bits);
  }

  Lobes lobes_ = no_lobes;
  bool reciprocal_ = true, prepared_ = false;
};

template <class... A>
nb::object PythonScatter::ask(const PartCall& call, const A&... arguments) const {
  if (last.number != number_) {
    Py_XDECREF(last.point);
    Py_XDECREF(last.wavelengths);
    last = {};
    last.point = nb::cast(PointView{point_}).release().ptr();
    last.wavelengths = PythonShader::wavelengths_object(wavelengths_).release().ptr();
    last.number = number_;
  }
  // Kept for the call: another shader that is called meanwhile replaces the last point.
  const nb::object point = nb::borrow(last.point), wavelengths = nb::borrow(last.wavelengths);
  PointView& view = *nb::inst_ptr<PointView>(point);
  view.point.object = point_.object;
  struct Forget {
    PointView& view;
    ~Forget() { view.point.object = nullptr; }
  } const forget{view};
  return call(point, wavelengths, arguments...);
}

/// The lobes of a call as an argument.
nb::object lobes_object(Lobes lobes) { return nb::int_(int(lobes)); }

Spectrum PythonScatter::local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
  const PartCall call(shader_, evaluate_name);
  return to_spectrum(ask(call, tuple_of(out), tuple_of(in), lobes_object(lobes)), call.called);
}

float PythonScatter::local_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
  const PartCall call(shader_, pdf_name);
  const nb::object returned = ask(call, tuple_of(out), tuple_of(in), lobes_object(lobes));
  const double pdf = to_number(returned, call.called);
  if (pdf < 0) call.called.refuse(returned, "a pdf [1/sr], which is not negative");
  return float(pdf);
}

/// The entries of what `sample` returns: an etendue.ScatterSample, or a tuple of the same.
bool PythonScatter::local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
  static const std::string wanted = "None, or an etendue.ScatterSample(direction, value, pdf, lobe, eta=1, dispersive=False)";
  const PartCall call(shader_, sample_name);
  const nb::object returned = ask(call, tuple_of(out), number(double(choice)), tuple_of(u), lobes_object(lobes));
  if (returned.is_none()) return false;
  if (!PyTuple_Check(returned.ptr())) call.called.refuse(returned, wanted);
  const Py_ssize_t count = PyTuple_Size(returned.ptr());
  if (count < 4 || count > 6) call.called.refuse(returned, wanted);
  const auto entry = [&](Py_ssize_t i) { return nb::handle(PyTuple_GetItem(returned.ptr(), i)); };
  s.in = to_vector(entry(0), call.called, "a direction of three finite numbers");
  if (std::abs(length_squared(s.in) - 1) > 2e-4f) call.called.refuse(entry(0), "a direction of unit length");
  s.value = to_spectrum(entry(1), call.called);
  s.pdf = float(to_number(entry(2), call.called));
  const double lobe = to_number(entry(3), call.called);
  if (!(lobe > 0 && lobe <= all_lobes) || std::popcount(unsigned(lobe)) != 1 || !(Lobes(lobe) & lobes))
    call.called.refuse(entry(3), fmt::format("one of the lobes that it was asked for ({})", int(lobes)));
  s.lobe = Lobe(int(lobe));
  if (count > 4) s.eta = float(to_number(entry(4), call.called));
  if (count > 5) s.dispersive = to_truth(entry(5), call.called);
  return s.pdf > 0;
}

Spectrum PythonScatter::local_albedo(const Vector3& out, Lobes lobes) const {
  const PartCall call(shader_, albedo_name);
  return to_spectrum(ask(call, tuple_of(out), lobes_object(lobes)), call.called);
}

Spectrum PythonScatter::relative_index(const Vector3& out, const Vector3& in) const {
  if (!shader_.defines(relative_index_name)) return Spectrum(1.0f);
  const PartCall call(shader_, relative_index_name);
  return to_spectrum(ask(call, tuple_of(out), tuple_of(in)), call.called);
}

bool PythonScatter::reciprocal() const { return shader_.reciprocal(); }

}  // namespace

PartInterface shader_interface() {
  return {"Shader",
          make_part<PythonShader>,
          {{"lobes", "self", "the kinds of scattering that it may have, bits of etendue.Lobe"},
           {"evaluate", "self, point, wavelengths, out, incident, lobes",
            "f [1/sr] without the cosine, of the lobes asked for that are not specular: a number or one for each wavelength. "
            "Directions are local: z is along the shading normal"},
           {"pdf", "self, point, wavelengths, out, incident, lobes", "the pdf [1/sr] with which `sample` samples `incident`"},
           {"sample", "self, point, wavelengths, out, choice, u, lobes",
            "an etendue.ScatterSample, or None: absorbed. choice and u = (u0, u1) are uniform in [0, 1)"},
           {"albedo", "self, point, wavelengths, out, lobes", "the fraction of uniform light that is scattered towards `out`"},
           {"interior_index", "self, wavelengths", "the refractive index inside the object, 1 by default"},
           {"relative_index", "self, point, wavelengths, out, incident",
            "for rough refraction: the index on the side of `incident` over that on the side of `out`"},
           {"reciprocal", "self", "whether f(out, incident) = f(incident, out); True by default"},
           {"lossless", "self", "whether nothing is absorbed; False by default"},
           {"albedo_error", "self", "a bound of the relative error of `albedo`; 0 by default"},
           prepare_method},
          {{"lobes"}, {"evaluate"}, {"pdf"}, {"sample"}, {"albedo"}}};
}

}  // namespace etendue::python
