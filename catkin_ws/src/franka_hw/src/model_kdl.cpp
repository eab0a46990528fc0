// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/model_kdl.h>
#include <urdf/model.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <limits>
#include <stdexcept>
#include <utility>

namespace franka_hw {

namespace {

constexpr std::size_t kJoints = 7;
constexpr std::chrono::milliseconds kSingularityCheckPeriod{100};

KDL::Frame toFrame(const std::array<double, 16>& transform) {
  const auto column = [&transform](std::size_t index) {
    return KDL::Vector(transform[4 * index], transform[4 * index + 1], transform[4 * index + 2]);
  };
  return {KDL::Rotation(column(0), column(1), column(2)), column(3)};
}

KDL::Vector toVector(const std::array<double, 3>& vector) {
  return {vector[0], vector[1], vector[2]};
}

KDL::RigidBodyInertia toInertia(double mass, const std::array<double, 3>& center_of_mass,
                                const std::array<double, 9>& inertia) {
  return KDL::RigidBodyInertia(mass, toVector(center_of_mass),
                               KDL::RotationalInertia(inertia[0], inertia[4], inertia[8],
                                                      inertia[1], inertia[2], inertia[5]));
}

std::invalid_argument refusal(const std::string& root, const std::string& tip,
                              const std::string& reason) {
  return std::invalid_argument("ModelKDL: the chain from '" + root + "' to '" + tip +
                               "' cannot be used: " + reason);
}

KDL::Chain chainFromUrdf(const urdf::Model& model, const std::string& root,
                         const std::string& tip) {
  KDL::Tree tree;
  if (!kdl_parser::treeFromUrdfModel(model, tree)) {
    throw refusal(root, tip, "KDL cannot read a kinematic tree from the robot description.");
  }
  for (const std::string& link : {root, tip}) {
    if (tree.getSegment(link) == tree.getSegments().end()) {
      throw refusal(root, tip,
                    "the robot description has no link '" + link +
                        "'; check that arm_id matches this model.");
    }
  }
  KDL::Chain chain;
  if (!tree.getChain(root, tip, chain)) {
    throw refusal(root, tip, "the two links are not connected.");
  }
  return chain;
}

/// Checks that a chain is an arm: seven revolute joints whose links have mass, then the fixed
/// flange.
void checkChain(const KDL::Chain& chain, const std::string& root, const std::string& tip) {
  if (chain.getNrOfJoints() != kJoints || chain.getNrOfSegments() <= kJoints) {
    throw refusal(root, tip,
                  "it has " + std::to_string(chain.getNrOfJoints()) + " moving and " +
                      std::to_string(chain.getNrOfSegments() - chain.getNrOfJoints()) +
                      " fixed joints instead of seven revolute ones and the fixed flange; use "
                      "<arm_id>_link0 and <arm_id>_link8.");
  }
  for (unsigned int i = 0; i < chain.getNrOfSegments(); ++i) {
    const KDL::Segment& segment = chain.getSegment(i);
    const bool moves = segment.getJoint().getType() != KDL::Joint::None;
    if (moves != (i < kJoints) || (moves && segment.getJoint().getType() != KDL::Joint::RotAxis)) {
      throw refusal(root, tip,
                    "joint '" + segment.getJoint().getName() + "' stands where an arm has " +
                        (i < kJoints ? "a revolute joint." : "a fixed one."));
    }
    if (moves && segment.getInertia().getMass() <= 0.0) {
      throw refusal(root, tip,
                    "link '" + segment.getName() +
                        "' has no mass; generate the robot description with gazebo:=true, which "
                        "adds the <inertial> elements.");
    }
  }
}

/// Merges the fixed end of a chain into its last moving segment, so that the chain ends in the
/// flange.
/// @returns the pose of the flange in the last moving link
KDL::Frame foldFixedEnd(KDL::Chain& chain) {
  KDL::Frame link_T_flange;
  for (unsigned int i = kJoints; i < chain.getNrOfSegments(); ++i) {
    link_T_flange = link_T_flange * chain.getSegment(i).getFrameToTip();
  }
  KDL::RigidBodyInertia inertia =
      link_T_flange.Inverse() * chain.getSegment(kJoints - 1).getInertia();
  KDL::Frame flange_T_segment = link_T_flange.Inverse();
  for (unsigned int i = kJoints; i < chain.getNrOfSegments(); ++i) {
    flange_T_segment = flange_T_segment * chain.getSegment(i).getFrameToTip();
    inertia = inertia + flange_T_segment * chain.getSegment(i).getInertia();
  }
  KDL::Chain folded;
  for (unsigned int i = 0; i + 1 < kJoints; ++i) {
    folded.addSegment(chain.getSegment(i));
  }
  const KDL::Segment& last = chain.getSegment(kJoints - 1);
  folded.addSegment(
      KDL::Segment(last.getName(), last.getJoint(), last.getFrameToTip() * link_T_flange, inertia));
  chain = folded;
  return link_T_flange;
}

}  // namespace

/// The chain and all data that the calls write.
///
/// The chain ends in the flange, and the payload is added to its last segment in place: the solvers
/// refer to the chain, so they use the payload without being built again.
struct ModelKDL::Workspace {
  Workspace(const urdf::Model& model, const std::string& root, const std::string& tip,
            double singularity_threshold)
      : Workspace(checkedChain(model, root, tip), singularity_threshold) {}

  Workspace(const KDL::Chain& unfolded, double singularity_threshold)
      : chain(unfolded),
        flange_T_link7(foldFixedEnd(chain).Inverse()),
        last_inertia(chain.getSegment(kJoints - 1).getInertia()),
        dynamics(chain, KDL::Vector::Zero()),
        threshold(singularity_threshold) {
    moved_to.fill(std::numeric_limits<double>::quiet_NaN());  // to nowhere
    for (unsigned int i = 0; i < kJoints; ++i) {
      const KDL::RigidBodyInertia& inertia = chain.getSegment(i).getInertia();
      masses[i] = inertia.getMass();
      first_moments[i] = inertia.getMass() * inertia.getCOG();
    }
  }

  static KDL::Chain checkedChain(const urdf::Model& model, const std::string& root,
                                 const std::string& tip) {
    KDL::Chain chain = chainFromUrdf(model, root, tip);
    checkChain(chain, root, tip);
    return chain;
  }

  void setPayload(const KDL::RigidBodyInertia& payload) {
    chain.getSegment(kJoints - 1).setInertia(last_inertia + payload);
  }

  /// Updates frames, joint axes and joint origins in O. Controllers ask for several quantities at
  /// the same positions.
  void moveTo(const std::array<double, 7>& positions) {
    if (positions == moved_to) {
      return;
    }
    moved_to = positions;
    KDL::Frame frame;
    for (unsigned int i = 0; i < kJoints; ++i) {
      const KDL::Segment& segment = chain.getSegment(i);
      axes[i] = frame.M * segment.getJoint().JointAxis();
      origins[i] = frame * segment.getJoint().JointOrigin();
      frame = frame * segment.pose(positions[i]);
      frames[i] = frame;
    }
  }

  /// Joint torques of a motion without acceleration of the joints and without gravity: recursive
  /// Newton-Euler, in the axes of O. Call moveTo() first.
  std::array<double, 7> coriolisTorques(const std::array<double, 7>& dq) const {
    std::array<KDL::Wrench, kJoints> wrenches;  // of inertia, about the joint's origin
    KDL::Vector omega = KDL::Vector::Zero();    // of the link
    KDL::Vector alpha = KDL::Vector::Zero();
    KDL::Vector acceleration = KDL::Vector::Zero();  // of the joint's origin
    for (std::size_t i = 0; i < kJoints; ++i) {
      if (i > 0) {
        acceleration += ofPoint(origins[i] - origins[i - 1], omega, alpha);
      }
      const KDL::Vector turn = axes[i] * dq[i];
      alpha += omega * turn;
      omega += turn;
      const KDL::Vector arm = frames[i].p - origins[i];
      wrenches[i] = inertialWrench(i, acceleration + ofPoint(arm, omega, alpha), omega, alpha);
      wrenches[i].torque += arm * wrenches[i].force;
    }
    std::array<double, 7> result;
    KDL::Wrench sum = KDL::Wrench::Zero();
    for (std::size_t i = kJoints; i-- > 0;) {
      if (i + 1 < kJoints) {
        sum.torque += (origins[i + 1] - origins[i]) * sum.force;
      }
      sum += wrenches[i];
      result[i] = KDL::dot(axes[i], sum.torque);
    }
    return result;
  }

  /// Pose of a frame in O. Call moveTo() first.
  KDL::Frame poseOf(franka::Frame frame, const std::array<double, 16>& F_T_EE,
                    const std::array<double, 16>& EE_T_K) const {
    const KDL::Frame& flange = frames.back();
    switch (frame) {
      case franka::Frame::kFlange:
        return flange;
      case franka::Frame::kEndEffector:
        return flange * toFrame(F_T_EE);
      case franka::Frame::kStiffness:
        return flange * toFrame(F_T_EE) * toFrame(EE_T_K);
      case franka::Frame::kJoint7:
        return flange * flange_T_link7;
      default:
        return frames[static_cast<std::size_t>(frame)];
    }
  }

  /// Jacobian of a point fixed to the link of a frame, in axes turned by rotation. Call moveTo()
  /// first.
  std::array<double, 42> jacobianOf(franka::Frame frame, const KDL::Vector& point,
                                    const KDL::Rotation& rotation) {
    std::array<double, 42> jacobian{};
    const std::size_t moved = std::min(static_cast<std::size_t>(frame) + 1, kJoints);
    for (std::size_t i = 0; i < moved; ++i) {
      const KDL::Vector linear = rotation * (axes[i] * (point - origins[i]));
      const KDL::Vector angular = rotation * axes[i];
      for (int row = 0; row < 3; ++row) {
        jacobian[6 * i + row] = linear(row);
        jacobian[6 * i + 3 + row] = angular(row);
      }
    }
    if (threshold >= 0.0 && frame >= franka::Frame::kFlange) {
      checkSingularity(jacobian);
    }
    return jacobian;
  }

  /// Acceleration of a point of a body, seen from another one. `*` is the cross product.
  static KDL::Vector ofPoint(const KDL::Vector& arm, const KDL::Vector& omega,
                             const KDL::Vector& alpha) {
    return alpha * arm + omega * (omega * arm);
  }

  /// Force and torque that move a link, about the origin of its frame, in the axes of O.
  /// @param acceleration of that origin
  KDL::Wrench inertialWrench(std::size_t link, const KDL::Vector& acceleration,
                             const KDL::Vector& omega, const KDL::Vector& alpha) const {
    const KDL::RigidBodyInertia& inertia = chain.getSegment(link).getInertia();
    const KDL::Rotation& R = frames[link].M;
    const KDL::Vector first_moment = R * (inertia.getMass() * inertia.getCOG());
    const KDL::Vector omega_link = R.Inverse(omega);
    const KDL::RotationalInertia& about_origin = inertia.getRotationalInertia();
    const KDL::Vector spin =
        about_origin * R.Inverse(alpha) + omega_link * (about_origin * omega_link);
    return {inertia.getMass() * acceleration + ofPoint(first_moment, omega, alpha),
            R * spin + first_moment * acceleration};
  }

  /// Runs at a reduced rate: an eigenvalue decomposition is expensive, and the warning is not
  /// needed at 1 kHz.
  void checkSingularity(const std::array<double, 42>& jacobian) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_check) {
      return;
    }
    next_check = now + kSingularityCheckPeriod;
    const Eigen::Map<const Eigen::Matrix<double, 6, 7>> J(jacobian.data());
    const Eigen::Matrix<double, 6, 6> JJt = J * J.transpose();
    eigenvalues.compute(JJt, Eigen::EigenvaluesOnly);
    if (eigenvalues.eigenvalues()[0] < threshold) {
      singular.store(true, std::memory_order_relaxed);
    }
  }

  KDL::Chain chain;
  const KDL::Frame flange_T_link7;
  const KDL::RigidBodyInertia last_inertia;  ///< of link 7 and flange without payload, in F
  std::array<double, kJoints> masses{};
  std::array<KDL::Vector, kJoints>
      first_moments;  ///< mass times center of mass, in the link's frame

  KDL::ChainDynParam dynamics;
  KDL::JntArray q{kJoints};
  KDL::JntSpaceInertiaMatrix mass_matrix{kJoints};

  std::array<double, kJoints> moved_to{};
  std::array<KDL::Frame, kJoints> frames;  ///< of the links in O; the last one is the flange's
  std::array<KDL::Vector, kJoints> axes;
  std::array<KDL::Vector, kJoints> origins;

  const double threshold;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigenvalues;
  std::chrono::steady_clock::time_point next_check{};
  std::atomic<bool> singular{false};
};

ModelKDL::ModelKDL(const urdf::Model& model, const std::string& root, const std::string& tip,
                   double singularity_threshold)
    : workspace_(std::make_unique<Workspace>(model, root, tip, singularity_threshold)) {}

ModelKDL::~ModelKDL() noexcept = default;

std::array<double, 16> ModelKDL::pose(franka::Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const {
  workspace_->moveTo(q);
  const KDL::Frame result = workspace_->poseOf(frame, F_T_EE, EE_T_K);
  std::array<double, 16> pose{};
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      pose[4 * column + row] = result.M(row, column);
    }
    pose[12 + column] = result.p(column);
  }
  pose[15] = 1.0;
  return pose;
}

std::array<double, 42> ModelKDL::bodyJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const {
  workspace_->moveTo(q);
  const KDL::Frame O_T_frame = workspace_->poseOf(frame, F_T_EE, EE_T_K);
  return workspace_->jacobianOf(frame, O_T_frame.p, O_T_frame.M.Inverse());
}

std::array<double, 42> ModelKDL::zeroJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const {
  workspace_->moveTo(q);
  const KDL::Frame O_T_frame = workspace_->poseOf(frame, F_T_EE, EE_T_K);
  return workspace_->jacobianOf(frame, O_T_frame.p, KDL::Rotation::Identity());
}

std::array<double, 49> ModelKDL::mass(const std::array<double, 7>& q,
                                      const std::array<double, 9>& total_inertia, double total_mass,
                                      const std::array<double, 3>& F_x_Ctotal) const {
  std::copy(q.begin(), q.end(), workspace_->q.data.data());
  workspace_->setPayload(toInertia(total_mass, F_x_Ctotal, total_inertia));
  workspace_->dynamics.JntToMass(workspace_->q, workspace_->mass_matrix);
  std::array<double, 49> mass;
  const double* values = workspace_->mass_matrix.data.data();
  std::copy(values, values + mass.size(), mass.begin());
  return mass;
}

std::array<double, 7> ModelKDL::coriolis(const std::array<double, 7>& q,
                                         const std::array<double, 7>& dq,
                                         const std::array<double, 9>& total_inertia,
                                         double total_mass,
                                         const std::array<double, 3>& F_x_Ctotal) const {
  workspace_->moveTo(q);
  workspace_->setPayload(toInertia(total_mass, F_x_Ctotal, total_inertia));
  return workspace_->coriolisTorques(dq);
}

std::array<double, 7> ModelKDL::gravity(const std::array<double, 7>& q, double total_mass,
                                        const std::array<double, 3>& F_x_Ctotal,
                                        const std::array<double, 3>& gravity_earth) const {
  // KDL's solver fixes the gravity vector when it is built. The static equilibrium holds for any
  // vector: the torque of each joint is the moment, about its axis, of the weight of all links
  // beyond it.
  Workspace& work = *workspace_;
  work.moveTo(q);
  const KDL::Vector g = toVector(gravity_earth);
  double mass = total_mass;
  KDL::Vector first_moment = work.frames.back() * toVector(F_x_Ctotal) * total_mass;
  std::array<double, 7> torques;
  for (std::size_t i = kJoints; i-- > 0;) {
    mass += work.masses[i];
    first_moment += work.frames[i].M * work.first_moments[i] + work.masses[i] * work.frames[i].p;
    torques[i] = -KDL::dot(work.axes[i], (first_moment - mass * work.origins[i]) * g);
  }
  return torques;
}

bool ModelKDL::takeSingularityWarning() noexcept {
  return workspace_->singular.exchange(false, std::memory_order_relaxed);
}

void ModelKDL::augmentFrame(const std::string& name, const std::array<double, 16>& transform,
                            KDL::Chain& chain) {
  chain.addSegment(KDL::Segment(name, KDL::Joint(KDL::Joint::None), toFrame(transform)));
}

void ModelKDL::augmentFrame(const std::string& name, const std::array<double, 3>& center_of_mass,
                            double mass, const std::array<double, 9>& inertia, KDL::Chain& chain) {
  chain.addSegment(KDL::Segment(name, KDL::Joint(KDL::Joint::None), KDL::Frame::Identity(),
                                toInertia(mass, center_of_mass, inertia)));
}

}  // namespace franka_hw
