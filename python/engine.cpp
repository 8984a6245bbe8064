// Repose: engines in Python. The interpreter's lock is let go while the library works; callbacks take it again.
#include <memory>
#include <optional>

#include "module.h"

namespace {

using repose::Engine;

std::int32_t target_of(const std::string& name) {
  if (name == "best") return REPOSE_TARGET_BEST;
  if (name == "baseline") return REPOSE_TARGET_BASELINE;
  if (name == "avx2") return REPOSE_TARGET_AVX2;
  if (name == "avx512") return REPOSE_TARGET_AVX512;
  throw py::value_error("target: choose among best, baseline, avx2, avx512");
}

std::unique_ptr<Engine> make_engine(const repose::Scene& scene, int threads, const std::string& target,
                                    double memory_limit, bool log_contacts, const py::object& log) {
  repose_engine_options options = repose_engine_options_init();
  options.threads = threads;
  options.target = target_of(target);
  options.memory_limit = memory_limit;
  options.log_contacts = log_contacts ? 1 : 0;
  Engine::Log tell;
  if (!log.is_none()) tell = log.cast<std::function<void(int, const char*)>>();
  const py::gil_scoped_release released;
  return std::make_unique<Engine>(scene, options, std::move(tell));
}

/// A new array that owns its numbers: `per_particle` of each, in rows where they are several.
template <class T>
py::array_t<T> array_of(std::size_t count, int per_particle) {
  if (per_particle == 1) return py::array_t<T>(static_cast<py::ssize_t>(count));
  return py::array_t<T>({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(per_particle)});
}

py::dict points(const Engine& engine, const std::vector<std::string>& attributes, const std::string& up,
                bool mass) {
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
    // Each number that an effect keeps is there under its own name.
    for (std::size_t set = 0; set < engine.set_count(); ++set) {
      const repose_set info = engine.set(set);
      for (std::size_t k = 0; k < info.channels; ++k) {
        repose_view view = repose_view_init();
        repose::detail::check(repose_channel(engine.get(), set, k, &view));
        std::int32_t components = 0;
        if (repose_points_components(made->get(), view.name, &components) == REPOSE_OK)
          names.push_back(view.name);
      }
    }
  }
  for (const std::string& name : names) {
    const int components = made->components(name);
    auto values = array_of<float>(count, components);
    if (count > 0) made->read(name, {values.mutable_data(), static_cast<std::size_t>(values.size())});
    arrays[py::str(name)] = values;
  }
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

void move_collider(Engine& engine, const std::string& collider, const Array<double>& matrix, double seconds) {
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
    throw py::value_error("matrix: needs the shape (4, 4)");
  std::array<double, 16> columns;
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column)
      columns[4 * column + row] = matrix.at(static_cast<py::ssize_t>(row), static_cast<py::ssize_t>(column));
  }
  engine.move_collider(collider, columns, seconds);
}

void deform_collider(Engine& engine, const std::string& collider, const Array<double>& vertices,
                     const std::optional<Array<std::int32_t>>& triangles, bool at_once) {
  const auto corners = rows_of_three(vertices, "vertices");
  const auto faces = triangles ? rows_of_three(*triangles, "triangles") : repose::Span<const std::int32_t>();
  const py::gil_scoped_release released;
  engine.deform_collider(collider, corners, faces, at_once);
}

std::uint32_t add_particles(Engine& engine, const std::string& emitter, const Array<double>& positions,
                            const std::optional<Array<float>>& velocities) {
  const auto places = rows_of_three(positions, "positions");
  const auto speeds = velocities ? rows_of_three(*velocities, "velocities") : repose::Span<const float>();
  const py::gil_scoped_release released;
  return engine.add_particles(emitter, places, speeds);
}

py::dict contact(const Engine& engine, const std::string& collider) {
  const repose_contact_info info = engine.contact(collider);
  py::dict figures;
  figures["seconds"] = info.seconds;
  figures["force"] = py::make_tuple(info.force[0], info.force[1], info.force[2]);
  figures["moment"] = py::make_tuple(info.moment[0], info.moment[1], info.moment[2]);
  figures["power"] = info.power;
  return figures;
}

py::bytes state(const Engine& engine) {
  std::vector<std::byte> bytes;
  {
    const py::gil_scoped_release released;
    bytes = engine.save();
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void restore(Engine& engine, const py::buffer& bytes) {
  const py::buffer_info info = bytes.request();
  const py::gil_scoped_release released;
  engine.load(repose::Span<const std::byte>(static_cast<const std::byte*>(info.ptr),
                                            static_cast<std::size_t>(info.size * info.itemsize)));
}

void define_reports(py::module_& module) {
  py::class_<repose_report>(module, "Report", "What a call that advances came to.")
      .def_readonly("frame", &repose_report::frame, "frames completed")
      .def_readonly("step", &repose_report::step, "steps completed")
      .def_readonly("time", &repose_report::time, "s, of the scene")
      .def_readonly("steps", &repose_report::steps, "made by this call")
      .def_readonly("least_dt", &repose_report::least_dt, "s")
      .def_readonly("most_dt", &repose_report::most_dt, "s")
      .def_readonly("redone", &repose_report::redone, "steps that were tried again by half")
      .def_property_readonly(
          "complete", [](const repose_report& r) { return r.complete != 0; },
          "whether it got as far as it was to; else call again to go on")
      .def_readonly("seconds", &repose_report::seconds, "s, of wall time");
  py::class_<repose_progress>(module, "Progress", "Where an engine is after a step.")
      .def_readonly("frame", &repose_progress::frame)
      .def_readonly("step", &repose_progress::step)
      .def_readonly("time", &repose_progress::time, "s")
      .def_readonly("dt", &repose_progress::dt, "s");
  py::class_<repose_info>(module, "Info", "Figures of an engine.")
      .def_readonly("frame", &repose_info::frame)
      .def_readonly("step", &repose_info::step)
      .def_readonly("time", &repose_info::time, "s, of the scene")
      .def_readonly("particles", &repose_info::particles)
      .def_readonly("particles_asleep", &repose_info::particles_asleep)
      .def_readonly("blocks", &repose_info::blocks)
      .def_readonly("generation", &repose_info::generation, "another one whenever views are stale")
      .def_readonly("memory", &repose_info::memory, "bytes")
      .def_readonly("threads", &repose_info::threads)
      .def_property_readonly("implicit", [](const repose_info& i) { return i.implicit != 0; })
      .def_property_readonly("sound", [](const repose_info& i) { return i.sound != 0; });
}

}  // namespace

void define_engine(py::module_& module) {
  define_reports(module);
  using Release = py::call_guard<py::gil_scoped_release>;
  py::class_<Engine>(module, "Engine", "A simulation.")
      .def(py::init(&make_engine), py::arg("scene"), py::arg("threads") = 0, py::arg("target") = "best",
           py::arg("memory_limit") = 0.0, py::arg("log_contacts") = false, py::arg("log") = py::none(),
           "Makes it: builds solids, fills bodies. threads 0: all; memory_limit in bytes, 0: 85 % of the "
           "machine's; "
           "log(level, message) is told of warnings.")
      .def("advance_frame", &Engine::advance_frame, Release(), "To the end of the frame at hand.")
      .def("advance_seconds", &Engine::advance_seconds, Release(), py::arg("seconds"),
           "So many s of the scene's time further; frames end on the way.")
      .def("advance_step", &Engine::advance_step, Release(),
           "By one step, to the end of the frame at the latest.")
      .def("interrupt", &Engine::interrupt,
           "From any thread: leaves the step at hand; the call comes back unfinished.")
      .def(
          "on_progress",
          [](Engine& engine, const py::object& progress) {
            Engine::Progress told;
            if (!progress.is_none()) {
              told = [function = progress.cast<std::function<py::object(const repose_progress&)>>()](
                         const repose_progress& at) {
                const py::gil_scoped_acquire acquired;
                const py::object answer = function(at);
                return answer.is_none() || answer.cast<bool>();
              };
            }
            engine.on_progress(std::move(told));
          },
          py::arg("progress"), "Calls progress(Progress) after each step; False ends the call that advances.")
      .def_property_readonly("info", &Engine::info, "Figures.")
      .def_property_readonly("hash", &Engine::hash, "Of the whole state, as run.json has it.")
      .def_property_readonly("warnings", &Engine::warnings)
      .def(
          "change",
          [](Engine& engine, const std::string& key, const py::object& value) {
            const std::string json = json_of(value);
            const py::gil_scoped_release released;
            engine.change(key, json);
          },
          py::arg("key"), py::arg("value"), "Goes on with a key of the scene at another value.")
      .def("save", py::overload_cast<const std::string&>(&Engine::save, py::const_), Release(), py::arg("path"))
      .def("load", py::overload_cast<const std::string&>(&Engine::load), Release(), py::arg("path"))
      .def("state", &state, "The state as bytes.")
      .def("restore", &restore, py::arg("state"), "Goes on from bytes of state().")
      .def(
          "points", &points, py::arg("attributes") = std::vector<std::string>(), py::arg("up") = "scene",
          py::arg("mass") = false,
          "Copies of P (m), v (m/s), id, pscale (m) and the attributes, in the order of ids: a dict of arrays.")
      .def("sets", &sets,
           "Names, figures and channels of the sets of particles, one for each body and emitter.")
      .def("view", &view, py::arg("set"), py::arg("channel"),
           "The engine's own numbers, without a copy and not to be written. They are valid until the next call "
           "that "
           "advances, loads, changes, adds or removes; info.generation is then another one.")
      .def(
          "block_corners",
          [](const Engine& engine) {
            const auto corners = engine.block_corners();
            auto array = array_of<double>(corners.size(), 3);
            for (std::size_t b = 0; b < corners.size(); ++b)
              std::copy(corners[b].begin(), corners[b].end(),
                        array.mutable_data(static_cast<py::ssize_t>(b), 0));
            return array;
          },
          "Where blocks lie, m, shape (blocks, 3).")
      .def(
          "measurements",
          [](const Engine& engine) {
            py::list list;
            for (const repose::Measurement& m : engine.measurements())
              list.append(py::make_tuple(m.probe, m.quantity, m.unit, m.value));
            return list;
          },
          "Tuples (probe, quantity, unit, value) of the frame that was completed last.")
      .def("move_collider", &move_collider, py::arg("collider"), py::arg("matrix"), py::arg("seconds"),
           "To a pose within seconds; matrix (4, 4) takes columns of points, so the translation is its last "
           "column.")
      .def("deform_collider", &deform_collider, py::arg("collider"), py::arg("vertices"),
           py::arg("triangles") = py::none(), py::arg("at_once") = false,
           "To vertices (n, 3), m, by the end of the stretch of 1/rate s that begins now.")
      .def("contact", &contact, py::arg("collider"),
           "Mean force (N) and moment (N m) of the material on a collider over the last call that advanced.")
      .def("add_particles", &add_particles, py::arg("emitter"), py::arg("positions"),
           py::arg("velocities") = py::none(), "Particles begin at (n, 3), m; returns the id of the first.")
      .def(
          "remove_particles",
          [](Engine& engine, const Array<std::uint32_t>& ids) {
            return engine.remove_particles({ids.data(), static_cast<std::size_t>(ids.size())});
          },
          py::arg("ids"), "Particles end; returns how many there were.");
}
