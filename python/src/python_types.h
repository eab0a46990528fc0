// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <vector>

/// @file
/// Objects of Python whose types signatures show: to help(), and to the types that a build makes of
/// the module (CMakeLists.txt). What they hold is checked with sentences (arguments.h), unless
/// accepts() says otherwise. A name without a module is one of this module or of Python.

namespace pyfranka::python {

/// @tparam Type with the type's `kName`, and whether an object can be one, `accepts`
template <typename Type>
class Object : public pybind11::object {
  PYBIND11_OBJECT(Object, pybind11::object, Type::accepts)
};

struct Unchecked {
  static bool accepts(PyObject* /* object */) { return true; }
};

struct ArrayLikeType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("numpy.typing.ArrayLike");
};
struct OptionalArrayLikeType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("Optional[numpy.typing.ArrayLike]");
};
struct FloatType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("float");
};
struct IntType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("int");
};
struct BoolType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("bool");
};
struct BoolSequenceType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("Sequence[bool]");
};
struct StrType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("str");
};
struct AnyDictType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("dict[str, typing.Any]");
};
struct DurationType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("Duration");
};
struct DurationValueType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("Union[int, datetime.timedelta]");
};
struct OptionalTimedeltaType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("Optional[datetime.timedelta]");
};
struct VersionType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("_Version");
};
struct ArrayPairType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name(
      "tuple[numpy.ndarray[numpy.float64], numpy.ndarray[numpy.float64]]");
};
struct StateAndPeriodType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("tuple[") +
                                pybind11::detail::make_caster<franka::RobotState>::name +
                                pybind11::detail::const_name(", Duration]");
};

/// Whatever a std::vector can be made of.
template <typename Value>
struct SequenceType {
  static constexpr auto kName = pybind11::detail::const_name("Sequence[") +
                                pybind11::detail::make_caster<Value>::name +
                                pybind11::detail::const_name("]");
  static bool accepts(PyObject* object) {
    return pybind11::detail::make_caster<std::vector<Value>>().load(object, true);
  }
};

/// An object of a class of C++, as it is in Python.
template <typename Class>
struct ClassType : Unchecked {
  static constexpr auto kName = pybind11::detail::make_caster<Class>::name;
};
template <typename Class>
struct OptionalClassType : Unchecked {
  static constexpr auto kName = pybind11::detail::const_name("Optional[") +
                                pybind11::detail::make_caster<Class>::name +
                                pybind11::detail::const_name("]");
};
template <typename Class>
struct ExactClassType : ClassType<Class> {
  static bool accepts(PyObject* object) { return pybind11::isinstance<Class>(object); }
};

/// A function of a state that returns something, called once a millisecond.
template <typename Command>
struct CallbackType {
  static constexpr auto kName = pybind11::detail::const_name("Callable[[") +
                                pybind11::detail::make_caster<franka::RobotState>::name +
                                pybind11::detail::const_name(", Duration], ") +
                                pybind11::detail::make_caster<Command>::name +
                                pybind11::detail::const_name("]");
  static bool accepts(PyObject* object) { return PyCallable_Check(object) != 0; }
};
struct ReaderType {
  static constexpr auto kName = pybind11::detail::const_name("Callable[[") +
                                pybind11::detail::make_caster<franka::RobotState>::name +
                                pybind11::detail::const_name("], object]");
  static bool accepts(PyObject* object) { return PyCallable_Check(object) != 0; }
};

using ArrayLike = Object<ArrayLikeType>;
using OptionalArrayLike = Object<OptionalArrayLikeType>;
using Float = Object<FloatType>;
using Int = Object<IntType>;
using Bool = Object<BoolType>;
using BoolSequence = Object<BoolSequenceType>;
using Str = Object<StrType>;
using AnyDict = Object<AnyDictType>;
using Duration = Object<DurationType>;
using DurationValue = Object<DurationValueType>;
using OptionalTimedelta = Object<OptionalTimedeltaType>;
using Version = Object<VersionType>;
using ArrayPair = Object<ArrayPairType>;
using StateAndPeriod = Object<StateAndPeriodType>;
using Reader = Object<ReaderType>;
template <typename Command>
using Callback = Object<CallbackType<Command>>;
template <typename Value>
using Sequence = Object<SequenceType<Value>>;
template <typename Class>
using ObjectOf = Object<ClassType<Class>>;
template <typename Class>
using OptionalObjectOf = Object<OptionalClassType<Class>>;
template <typename Class>
using Exactly = Object<ExactClassType<Class>>;

}  // namespace pyfranka::python

namespace pybind11::detail {

template <typename Type>
struct handle_type_name<pyfranka::python::Object<Type>> {
  static constexpr auto name = Type::kName;  // NOLINT(readability-identifier-naming)  pybind11's
};

}  // namespace pybind11::detail
