// Repose: engines in Python. The interpreter's lock is let go while the library works; callbacks take it again.
#include <map>
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

std::array<double, 3> triple(const std::optional<std::array<double, 3>>& given) {
  return given.value_or(std::array<double, 3>{});
}

void drive_collider(Engine& engine, const std::string& collider,
                    const std::optional<std::array<double, 3>>& velocity,
                    const std::optional<std::array<double, 3>>& spin,
                    const std::optional<std::array<double, 3>>& center) {
  if (!velocity && !spin) {
    engine.release_collider(collider);
  } else {
    engine.drive_collider(collider, triple(velocity), triple(spin), triple(center));
  }
}

std::uint32_t add_particles(Engine& engine, const std::string& emitter, const Array<double>& positions,
                            const std::optional<Array<float>>& velocities,
                            const std::map<std::string, Array<float>>& channels) {
  const auto places = rows_of_three(positions, "positions");
  const auto speeds = velocities ? rows_of_three(*velocities, "velocities") : repose::Span<const float>();
  Engine::Values values;
  for (const auto& [channel, numbers] : channels) values.emplace_back(channel, all_of(numbers));
  const py::gil_scoped_release released;
  return engine.add_particles(emitter, places, speeds, values);
}

std::size_t set_values(Engine& engine, const std::string& channel, const Array<std::uint32_t>& ids,
                       const Array<float>& values) {
  const auto numbers = all_of(values);
  const auto of = all_of(ids);
  const py::gil_scoped_release released;
  return engine.set_values(channel, of, numbers);
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
  py::class_<Engine> engine(module, "Engine", "A simulation.");
  define_reading(engine);
  engine
      .def(py::init(&make_engine), py::arg("scene"), py::arg("threads") = 0, py::arg("target") = "best",
           py::arg("memory_limit") = 0.0, py::arg("log_contacts") = false, py::arg("log") = py::none(),
           "Makes it: builds solids, fills bodies. threads 0: all, -1: the arena of oneTBB that the caller "
           "is in; memory_limit in bytes, 0: 85 % of the machine's; log(level, message) is told of warnings.")
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
      .def("drive_collider", &drive_collider, py::arg("collider"), py::arg("velocity") = py::none(),
           py::arg("spin") = py::none(), py::arg("center") = py::none(),
           "Its surface moves with velocity + spin x (x - center), in m/s, rad/s and m, whatever its poses "
           "come to; without velocity and spin by its poses again.")
      .def("add_particles", &add_particles, py::arg("emitter"), py::arg("positions"),
           py::arg("velocities") = py::none(), py::arg("channels") = std::map<std::string, Array<float>>(),
           "Particles begin at (n, 3), m, with numbers of the scene's channels by name, (n,) or "
           "(n, components); returns the id of the first.")
      .def("set_values", &set_values, py::arg("channel"), py::arg("ids"), py::arg("values"),
           "Other numbers of a channel for particles of ids; returns how many of them there were.")
      .def(
          "remove_particles",
          [](Engine& engine, const Array<std::uint32_t>& ids) {
            return engine.remove_particles({ids.data(), static_cast<std::size_t>(ids.size())});
          },
          py::arg("ids"), "Particles end; returns how many there were.");
}
