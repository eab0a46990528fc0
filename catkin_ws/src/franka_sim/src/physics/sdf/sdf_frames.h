// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace franka_sim::physics {

/// The <pose> of an element as written: meters, then roll, pitch, yaw [rad] (or degrees, if the
/// text says so) or a quaternion x y z w. The identity if there is none.
/// @throws std::runtime_error with a sentence if it is not six (seven) finite numbers.
Eigen::Isometry3d writtenPose(const tinyxml2::XMLElement& element, const std::string& where);

/// Whether a model's elements belong to the model around it: `<include merge="true">`.
bool isMerged(const tinyxml2::XMLElement& model);

/// The frames of one SDF world or model, and of the models in it: SDF 1.7's pose semantics, where
/// each pose names its reference frame. Frames of inner models are named "model::frame". Refers to
/// the document, which must outlive it.
class SdfFrames {
 public:
  /// @param scope <world>, <model>, or <sdf> around a lone model
  /// @param title names the text in errors
  /// @throws std::runtime_error when two frames have one name.
  SdfFrames(const tinyxml2::XMLElement& scope, const std::string& title);

  /// A frame's pose in the scope; "", "__model__" and "world" are the scope itself.
  /// @throws std::runtime_error when there is no such frame, or poses refer to each other in a
  /// circle.
  Eigen::Isometry3d pose(const std::string& frame) const;
  /// The pose of an element in the scope; it is relative to `frame` unless its <pose> says
  /// otherwise.
  Eigen::Isometry3d poseOf(const tinyxml2::XMLElement& element, const std::string& frame) const;
  /// The same, in `frame`. Exact if the <pose> is relative to `frame`.
  Eigen::Isometry3d poseIn(const tinyxml2::XMLElement& element, const std::string& frame) const;
  /// The link that a frame is fixed to ("model::link" in an inner model), or "world".
  /// @throws std::runtime_error as pose().
  std::string linkOf(const std::string& frame) const;
  /// The frames of an inner model. @throws std::runtime_error when there is no such model.
  const SdfFrames& model(const std::string& name) const;

 private:
  struct Frame {
    const tinyxml2::XMLElement* element;
    std::unique_ptr<SdfFrames> model;  ///< the frames of an inner model
  };

  /// The own element that a name begins with, and the rest, which is a name in that inner model.
  std::pair<std::string, std::string> split(const std::string& name) const;
  const Frame& find(const std::string& name) const;
  std::string canonicalLink() const;

  const tinyxml2::XMLElement& scope_;
  std::string title_;
  std::map<std::string, Frame> frames_;
  mutable int depth_{0};  ///< of references followed, to find circles
};

}  // namespace franka_sim::physics
