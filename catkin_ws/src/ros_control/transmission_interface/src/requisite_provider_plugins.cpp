// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <transmission_interface/bidirectional_effort_joint_interface_provider.h>
#include <transmission_interface/bidirectional_position_joint_interface_provider.h>
#include <transmission_interface/bidirectional_velocity_joint_interface_provider.h>
#include <transmission_interface/effort_joint_interface_provider.h>
#include <transmission_interface/joint_state_interface_provider.h>
#include <transmission_interface/position_joint_interface_provider.h>
#include <transmission_interface/velocity_joint_interface_provider.h>

#include <pluginlib/class_list_macros.hpp>

PLUGINLIB_EXPORT_CLASS(transmission_interface::JointStateInterfaceProvider,
                       transmission_interface::RequisiteProvider)
PLUGINLIB_EXPORT_CLASS(transmission_interface::PositionJointInterfaceProvider,
                       transmission_interface::RequisiteProvider)
PLUGINLIB_EXPORT_CLASS(transmission_interface::VelocityJointInterfaceProvider,
                       transmission_interface::RequisiteProvider)
PLUGINLIB_EXPORT_CLASS(transmission_interface::EffortJointInterfaceProvider,
                       transmission_interface::RequisiteProvider)
PLUGINLIB_EXPORT_CLASS(transmission_interface::BiDirectionalPositionJointInterfaceProvider,
                       transmission_interface::RequisiteProvider)
PLUGINLIB_EXPORT_CLASS(transmission_interface::BiDirectionalVelocityJointInterfaceProvider,
                       transmission_interface::RequisiteProvider)
PLUGINLIB_EXPORT_CLASS(transmission_interface::BiDirectionalEffortJointInterfaceProvider,
                       transmission_interface::RequisiteProvider)
