#include "arrays.h"

namespace talus::python {

// Contact points and rows as records of NumPy.
struct ContactRecord {
  int32_t block_a, block_b, joint;
  double normal, shear, length, slip;
};
struct PointRecord {
  int32_t kind, state, block_a, block_b;
  double x, y, force_x, force_y, normal, shear, gap, length, slip, slip_left, opening;
};
struct RowRecord {
  int32_t family, block_a, block_b, partner;
  double normal_x, normal_y, impulse_normal, impulse_shear, bias_normal, bias_shear, compliance_normal,
      compliance_shear, lower, upper, friction, cohesion;
};

namespace {

// Numbers of n blocks, of each an array of `shape`, that lie `stride` bytes apart: without a copy; keeps `memory` alive.
py::array view(const std::shared_ptr<Memory>& memory, const void* first, size_t n,
               std::vector<py::ssize_t> shape, py::ssize_t stride) {
  shape.insert(shape.begin(), static_cast<py::ssize_t>(n));
  std::vector<py::ssize_t> strides(shape.size(), sizeof(double));
  for (size_t k = shape.size() - 1; k > 1; --k) strides[k - 1] = strides[k] * shape[k];
  strides[0] = stride;
  const py::capsule owner(new std::shared_ptr<Memory>(memory),
                          [](void* p) { delete static_cast<std::shared_ptr<Memory>*>(p); });
  py::array out(py::dtype::of<double>(), shape, strides, first, owner);
  py::detail::array_proxy(out.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return out;
}

template <class Record>
py::array_t<Record> records(const std::vector<Record>& of) {
  py::array_t<Record> out(static_cast<py::ssize_t>(of.size()));
  std::copy(of.begin(), of.end(), out.mutable_data());
  return out;
}

}  // namespace

py::array Views::displacement() const {
  return view(memory, state().displacement.data(), state().displacement.size(), {2}, sizeof(Vec2));
}
py::array Views::strain_part() const {
  return view(memory, state().strain_part.data(), state().strain_part.size(), {2, 2}, sizeof(Mat2));
}
py::array Views::rate() const {
  const auto& r = state().rate;
  return view(memory, r.empty() ? nullptr : &r[0].a, r.size(), {2}, sizeof(BlockRate));
}
py::array Views::rate_gradient() const {
  const auto& r = state().rate;
  return view(memory, r.empty() ? nullptr : &r[0].G, r.size(), {2, 2}, sizeof(BlockRate));
}

py::array contacts_of(const State& state) {
  std::vector<ContactRecord> rows;
  rows.reserve(state.contacts.size());
  for (const Patch& p : state.patches)
    for (size_t end = 0; end < 2; ++end)
      rows.push_back(
          {p.block_a, p.block_b, p.joint, p.force[end][0], p.force[end][1], 0.5 * p.length, p.slip[end]});
  for (const Contact& c : state.contacts)
    rows.push_back({c.key.block_a, c.key.block_b, c.joint, c.force[0], c.force[1], c.length, c.slip});
  return records(rows);
}

py::array points_of(const Instant& instant) {
  std::vector<PointRecord> rows;
  for (const FramePoint& p : frame_points(instant.scene, instant))
    rows.push_back({p.kind, p.state, p.block_a, p.block_b, p.point.x, p.point.y, p.force.x, p.force.y,
                    p.normal_force, p.shear_force, p.gap, p.length, p.slip, p.slip_signed, p.opening});
  return records(rows);
}
py::array rows_of(const Instant& instant) {
  const RowSet& set = instant.work.rows;
  std::vector<RowRecord> rows;
  for (size_t k = 0; k < set.size(); ++k) {
    const PointRows& p = set.points[k];
    rows.push_back({static_cast<int32_t>(set.owner[k].family), p.block_a, p.block_b, p.partner, p.normal.x,
                    p.normal.y, set.impulse[k][0], set.impulse[k][1], p.row[0].bias, p.row[1].bias,
                    p.row[0].compliance, p.row[1].compliance, p.lower, p.upper, p.friction, p.cohesion});
  }
  return records(rows);
}

py::array velocity_of(const Instant& i) {
  py::array_t<double> out({static_cast<py::ssize_t>(i.state.rate.size()), static_cast<py::ssize_t>(2)});
  double* to = out.mutable_data();
  for (size_t k = 0; k < i.state.rate.size(); ++k) {
    const Vec2 a = rate_now(i.work, i.state, k).a;
    *to++ = a.x, *to++ = a.y;
  }
  return out;
}
py::array stress_of(const Scene& scene, const State& state) {
  const auto blocks = static_cast<py::ssize_t>(state.displacement.size());
  py::array_t<double> out({blocks, static_cast<py::ssize_t>(2), static_cast<py::ssize_t>(2)});
  double* to = out.mutable_data();
  for (int k = 0; k < scene.blocks.count; ++k) {
    const Mat2 m = cauchy_stress(scene.blocks, state, k);
    *to++ = m.xx, *to++ = m.xy, *to++ = m.yx, *to++ = m.yy;
  }
  return out;
}

void bind_views(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(ContactRecord, block_a, block_b, joint, normal, shear, length, slip);
  PYBIND11_NUMPY_DTYPE(PointRecord, kind, state, block_a, block_b, x, y, force_x, force_y, normal, shear, gap,
                       length, slip, slip_left, opening);
  PYBIND11_NUMPY_DTYPE(RowRecord, family, block_a, block_b, partner, normal_x, normal_y, impulse_normal,
                       impulse_shear, bias_normal, bias_shear, compliance_normal, compliance_shear, lower,
                       upper, friction, cohesion);

  py::class_<Views, std::shared_ptr<Views>>(
      m, "_Views", "Numbers of blocks that lie in one place from the start of a run on.")
      .def_property_readonly(
          "displacement", &Views::displacement,
          "displacements of the centroids [m], (blocks, 2): a read-only view, not a copy, that goes on with the run and "
          "stays valid after it (theory 1.1)")
      .def_property_readonly(
          "strain_part", &Views::strain_part,
          "deformation gradients F - I [-], (blocks, 2, 2): a view as displacement (theory 1.1)")
      .def_property_readonly(
          "rate", &Views::rate,
          "velocities of the centroids half a step on [m/s], (blocks, 2): of an instant in the middle of the step that follows (of the "
          "last one: before), between steps in the middle of the one before; a view as displacement (theory 2.1)")
      .def_property_readonly(
          "rate_gradient", &Views::rate_gradient,
          "rates of the deformation gradients then [1/s], (blocks, 2, 2); of blocks that do not deform the spin matrix: a "
          "view as displacement");
}

}  // namespace talus::python
