// Repose: what the files of the Python module share. It stands on repose.hpp alone.
#pragma once

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <repose/repose.hpp>
#include <string>
#include <vector>

namespace py = pybind11;

/// Arrays of Python, brought into the type and order that the library takes; copied only where they have
/// another.
template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// Rows of three numbers, as one span. Refuses other shapes with ValueError; `name` stands for the array.
template <class T>
repose::Span<const T> rows_of_three(const Array<T>& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw py::value_error(std::string(name) + ": needs the shape (n, 3)");
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// All numbers of an array, row by row.
template <class T>
repose::Span<const T> all_of(const Array<T>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// A new array that owns its numbers: `per_particle` of each, in rows where they are several.
template <class T>
py::array_t<T> array_of(std::size_t count, int per_particle) {
  if (per_particle == 1) return py::array_t<T>(static_cast<py::ssize_t>(count));
  return py::array_t<T>({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(per_particle)});
}

/// JSON of a value: text stays what it is, all else goes through json.dumps.
std::string json_of(const py::object& value);

void define_scene(py::module_& module);
void define_engine(py::module_& module);
void define_reading(py::class_<repose::Engine>& engine);
