// Repose: what Python reads of an engine: copies of particles, arrays over the engine's own numbers, and
// volumes.
#include <algorithm>
#include <optional>

#include "module.h"

namespace {

using repose::Engine;

/// An attribute of particles, in single precision or half of it.
py::array attribute(const repose::Points& points, const std::string& name, bool half) {
  const int components = points.components(name);
  auto whole = array_of<float>(half ? 0 : points.size(), components);
  if (!half) {
    if (points.size() > 0) points.read(name, {whole.mutable_data(), static_cast<std::size_t>(whole.size())});
    return std::move(whole);
  }
  auto bits = array_of<std::uint16_t>(points.size(), components);
  if (points.size() > 0)
    repose::detail::check(repose_points_read_half(points.get(), name.c_str(), bits.mutable_data(),
                                                  static_cast<std::size_t>(bits.size())));
  return bits.attr("view")("float16");
}

py::dict points(const Engine& engine, const std::vector<std::string>& attributes, const std::string& up,
                bool mass, bool half) {
  repose_points_options options = repose_points_options_init();
  std::string list;
  for (const std::string& name : attributes) list += (list.empty() ? "" : ",") + name;
  options.attributes = list.c_str();
  options.mass = mass ? 1 : 0;
  if (up != "scene" && up != "y" && up != "z") throw py::value_error("up: choose among scene, y, z");
  options.up = up == "y" ? REPOSE_UP_Y : up == "z" ? REPOSE_UP_Z : REPOSE_UP_OF_SCENE;
  std::optional<repose::Points> made;
  {
    const py::gil_scoped_release released;
    made.emplace(engine.points(options));
  }
  const std::size_t count = made->size();
  py::dict arrays;
  auto positions = array_of<double>(count, 3);
  auto ids = array_of<std::uint32_t>(count, 1);
  if (count > 0) {
    repose::detail::check(repose_points_positions(made->get(), positions.mutable_data(), 3 * count));
    repose::detail::check(repose_points_ids(made->get(), ids.mutable_data(), count));
  }
  arrays["P"] = positions;
  arrays["id"] = ids;
  std::vector<std::string> names{"v", "pscale"};
  if (mass) names.push_back("mass");
  for (const std::string& name : attributes) {
    if (name != "channels") {
      names.push_back(name);
      continue;
    }
    // Each number that is kept is there under its own name, and those of "Cd.x", "Cd.y" ... under one.
    for (std::size_t set = 0; set < engine.set_count(); ++set) {
      const repose_set info = engine.set(set);
      for (std::size_t k = 0; k < info.channels; ++k) {
        repose_view view = repose_view_init();
        repose::detail::check(repose_channel(engine.get(), set, k, &view));
        const std::string kept = view.name;
        const std::string stem = kept.substr(0, kept.find('.'));
        std::int32_t components = 0;
        if (repose_points_components(made->get(), stem.c_str(), &components) == REPOSE_OK &&
            std::find(names.begin(), names.end(), stem) == names.end())
          names.push_back(stem);
      }
    }
  }
  for (const std::string& name : names) arrays[py::str(name)] = attribute(*made, name, half);
  return arrays;
}

/// An array over the engine's own numbers, which keeps the engine alive and cannot be written.
py::array view(const py::object& self, std::size_t set, const std::string& name) {
  repose_view view = repose_view_init();
  repose::detail::check(repose_channel_named(self.cast<const Engine&>().get(), set, name.c_str(), &view));
  const py::dtype type = view.type == REPOSE_FLOAT    ? py::dtype::of<float>()
                         : view.type == REPOSE_DOUBLE ? py::dtype::of<double>()
                                                      : py::dtype::of<std::uint32_t>();
  py::array array(type, static_cast<py::ssize_t>(view.count), view.data, self);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::list sets(const Engine& engine) {
  py::list list;
  for (std::size_t k = 0; k < engine.set_count(); ++k) {
    const repose_set set = engine.set(k);
    py::list channels;
    for (std::size_t c = 0; c < set.channels; ++c) {
      repose_view view = repose_view_init();
      repose::detail::check(repose_channel(engine.get(), k, c, &view));
      channels.append(view.name);
    }
    py::dict entry;
    entry["name"] = set.name;
    entry["material"] = set.material;
    entry["particle_mass"] = set.particle_mass;
    entry["particle_volume"] = set.particle_volume;
    entry["count"] = set.count;
    entry["channels"] = channels;
    list.append(entry);
  }
  return list;
}

/// A dict of arrays (x, y, z), or (x, y, z, 3) of vectors, and where they lie.
py::dict boxes(const repose::Volume& volume, const std::vector<std::string>& grids) {
  const repose_lattice& lattice = volume.lattice();
  py::dict made;
  made["lower"] = py::make_tuple(lattice.lower[0], lattice.lower[1], lattice.lower[2]);
  made["voxel"] = py::make_tuple(lattice.voxel[0], lattice.voxel[1], lattice.voxel[2]);
  for (const std::string& grid : grids) {
    std::vector<py::ssize_t> shape(lattice.count, lattice.count + 3);
    if (grid == "v") shape.push_back(3);
    py::array_t<float> values(shape);
    if (values.size() > 0) volume.read(grid, {values.mutable_data(), static_cast<std::size_t>(values.size())});
    made[py::str(grid)] = values;
  }
  return made;
}

py::dict surface(const Engine& engine, double voxel, double radius, int smoothing) {
  repose_surface_options options = repose_surface_options_init();
  options.voxel = voxel;
  options.radius = radius;
  options.smoothing = smoothing;
  std::optional<repose::Volume> made;
  {
    const py::gil_scoped_release released;
    made.emplace(engine.surface(options));
  }
  return boxes(*made, {"surface"});
}

py::dict fog(const Engine& engine, double voxel) {
  std::optional<repose::Volume> made;
  {
    const py::gil_scoped_release released;
    made.emplace(engine.fog(voxel));
  }
  return boxes(*made, {"density", "v"});
}

py::array_t<double> block_corners(const Engine& engine) {
  const auto corners = engine.block_corners();
  auto array = array_of<double>(corners.size(), 3);
  for (std::size_t b = 0; b < corners.size(); ++b)
    std::copy(corners[b].begin(), corners[b].end(), array.mutable_data(static_cast<py::ssize_t>(b), 0));
  return array;
}

}  // namespace

void define_reading(py::class_<Engine>& engine) {
  engine
      .def(
          "points", &points, py::arg("attributes") = std::vector<std::string>(), py::arg("up") = "scene",
          py::arg("mass") = false, py::arg("half") = false,
          "Copies of P (m), v (m/s), id, pscale (m) and the attributes, in the order of ids: a dict of arrays. "
          "Attributes are those of the scene's output, and names of its channels; with half, all but P and "
          "id are float16.")
      .def("surface", &surface, py::arg("voxel") = 0.0, py::arg("radius") = 0.0, py::arg("smoothing") = -1,
           "The surface as signed distances, m: a dict of \"surface\" (x, y, z), \"lower\", where its "
           "first value lies, and \"voxel\", from one to the next, m. voxel and radius in m; what is left "
           "out is the scene's.")
      .def("fog", &fog, py::arg("voxel") = 0.0,
           "\"density\" (x, y, z), kg/m^3, and \"v\" (x, y, z, 3), m/s, on voxels, with \"lower\" and "
           "\"voxel\", m.")
      .def("sets", &sets,
           "Names, figures and channels of the sets of particles, one for each body and emitter.")
      .def("view", &view, py::arg("set"), py::arg("channel"),
           "The engine's own numbers, without a copy and not to be written. They are valid until the next call "
           "that advances, loads, changes, adds or removes; info.generation is then another one.")
      .def("block_corners", &block_corners, "Where blocks lie, m, shape (blocks, 3).");
}
