// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

// Replaces Boost's header of this name, under the same include guard.
//
// With Boost's own header, _1 in the global namespace is another variable than
// std::placeholders::_1, and code with `using namespace std::placeholders` becomes ambiguous. Here
// both are one variable, which boost::bind and std::bind both accept: Boost only checks
// boost::is_placeholder, and the result of boost::bind keeps its type.
#ifndef BOOST_BIND_PLACEHOLDERS_HPP_INCLUDED
#define BOOST_BIND_PLACEHOLDERS_HPP_INCLUDED

#include <boost/bind/arg.hpp>
#include <functional>
#include <type_traits>

// Newer versions of Boost already treat std's placeholders as placeholders.
#if __has_include(<boost/bind/std_placeholders.hpp>)
#include <boost/bind/std_placeholders.hpp>
#else
#define BOOST_BIND_COMPAT_PLACEHOLDER(number)                                           \
  template <>                                                                           \
  struct is_placeholder<std::remove_cv<decltype(std::placeholders::_##number)>::type> { \
    enum _vt { value = number };                                                        \
  };
namespace boost {
BOOST_BIND_COMPAT_PLACEHOLDER(1)
BOOST_BIND_COMPAT_PLACEHOLDER(2)
BOOST_BIND_COMPAT_PLACEHOLDER(3)
BOOST_BIND_COMPAT_PLACEHOLDER(4)
BOOST_BIND_COMPAT_PLACEHOLDER(5)
BOOST_BIND_COMPAT_PLACEHOLDER(6)
BOOST_BIND_COMPAT_PLACEHOLDER(7)
BOOST_BIND_COMPAT_PLACEHOLDER(8)
BOOST_BIND_COMPAT_PLACEHOLDER(9)
}  // namespace boost
#undef BOOST_BIND_COMPAT_PLACEHOLDER
#endif

namespace boost {
namespace placeholders {
using std::placeholders::_1;
using std::placeholders::_2;
using std::placeholders::_3;
using std::placeholders::_4;
using std::placeholders::_5;
using std::placeholders::_6;
using std::placeholders::_7;
using std::placeholders::_8;
using std::placeholders::_9;
}  // namespace placeholders
}  // namespace boost

// In the global namespace too, for sources that include nothing but generated messages and headers
// of actionlib or roscpp.
#ifndef BOOST_BIND_NO_PLACEHOLDERS
using namespace boost::placeholders;  // NOLINT(google-build-using-namespace)
#endif

#endif
