// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_models.h>
#include <franka_sim/simulation/batch.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace franka_sim {
namespace {

using franka_core::RobotState;

template <std::size_t size>
constexpr std::size_t sizeOf(std::array<double, size> RobotState::* /*field*/) {
  return size;
}

template <auto field>
void readField(const SimulatedRobot& robot, double* values) {
  const auto& array = robot.state().*field;
  std::copy(array.begin(), array.end(), values);
}

void readMode(const SimulatedRobot& robot, double* values) {
  *values = static_cast<double>(robot.state().robot_mode);
}

void readWidth(const SimulatedRobot& robot, double* values) {
  *values = robot.units().hand()->width();
}

struct Field {
  const char* name;
  std::size_t size;
  void (*read)(const SimulatedRobot&, double*);
};

template <auto field>
constexpr Field arrayField(const char* name) {
  return {name, sizeOf(field), &readField<field>};
}

const std::array kFields{
    arrayField<&RobotState::q>("q"),
    arrayField<&RobotState::dq>("dq"),
    arrayField<&RobotState::q_d>("q_d"),
    arrayField<&RobotState::dq_d>("dq_d"),
    arrayField<&RobotState::tau_J>("tau_J"),
    arrayField<&RobotState::tau_J_d>("tau_J_d"),
    arrayField<&RobotState::dtau_J>("dtau_J"),
    arrayField<&RobotState::tau_ext_hat_filtered>("tau_ext_hat_filtered"),
    arrayField<&RobotState::O_T_EE>("O_T_EE"),
    arrayField<&RobotState::O_T_EE_d>("O_T_EE_d"),
    arrayField<&RobotState::elbow>("elbow"),
    arrayField<&RobotState::O_F_ext_hat_K>("O_F_ext_hat_K"),
    arrayField<&RobotState::K_F_ext_hat_K>("K_F_ext_hat_K"),
    Field{"robot_mode", 1, &readMode},
    Field{"width", 1, &readWidth},
};

constexpr std::size_t kPoseSize = 7;
constexpr std::size_t kTwistSize = 6;

std::string listOfFields() {
  std::string names;
  for (const Field& field : kFields) {
    names += (names.empty() ? "" : ", ") + std::string(field.name);
  }
  return names;
}

}  // namespace

Observer::Observer(Simulation& simulation, const std::vector<std::string>& names)
    : simulation_(&simulation) {
  for (const std::string& name : names) {
    add(name);
  }
}

std::vector<std::string> Observer::defaultNames(Simulation& simulation) {
  std::vector<std::string> names{"time"};
  for (const SimulatedRobot& robot : simulation.robots()) {
    for (const char* field : {"q", "dq", "O_T_EE", "robot_mode"}) {
      names.push_back(robot.setup().arm_id + "." + field);
    }
    if (robot.units().hand() != nullptr) {
      names.push_back(robot.setup().arm_id + ".width");
    }
  }
  const std::vector<std::string> robots = simulation.world().robots();
  for (const WorldModel& model : models(simulation.world())) {
    const bool is_robot = std::find(robots.begin(), robots.end(), model.name) != robots.end();
    if (!is_robot && !model.is_static) {
      names.push_back(model.body + ".pose");
    }
  }
  return names;
}

std::vector<std::string> Observer::names() const {
  std::vector<std::string> names;
  for (const Value& value : layout_) {
    names.push_back(value.name);
  }
  return names;
}

std::size_t Observer::size() const noexcept {
  std::size_t sum = 0;
  for (const Value& value : layout_) {
    sum += value.size;
  }
  return sum;
}

void Observer::add(const std::string& name) {
  for (const Value& value : layout_) {
    if (value.name == name) {
      throw std::invalid_argument("The value '" + name + "' is named twice.");
    }
  }
  const std::size_t at = size();
  const std::size_t dot = name.rfind('.');
  const std::string owner = name.substr(0, dot);
  const std::string field = dot == std::string::npos ? "" : name.substr(dot + 1);
  const std::vector<std::string> bodies = simulation_->world().bodies();
  if (name == "time") {
    times_.push_back(at);
    layout_.push_back({name, 1});
  } else if ((field == "pose" || field == "twist") &&
             std::find(bodies.begin(), bodies.end(), owner) != bodies.end()) {
    bodies_.push_back({field == "twist", at});
    body_names_.push_back(owner);
    layout_.push_back({name, field == "twist" ? kTwistSize : kPoseSize});
  } else if (!addOfRobot(owner, field)) {
    throw std::invalid_argument("There is no value '" + name +
                                "'. Known are time, a body with .pose or .twist, and a robot with "
                                "one of: " +
                                listOfFields() + ".");
  }
}

bool Observer::addOfRobot(const std::string& owner, const std::string& field) {
  const auto& robots = simulation_->robots();
  const auto robot = std::find_if(robots.begin(), robots.end(), [&](const SimulatedRobot& one) {
    return one.setup().arm_id == owner;
  });
  const auto known = std::find_if(kFields.begin(), kFields.end(),
                                  [&](const Field& one) { return field == one.name; });
  if (robot == robots.end() || known == kFields.end()) {
    return false;
  }
  if (known->read == &readWidth && robot->units().hand() == nullptr) {
    throw std::invalid_argument("The robot '" + owner + "' has no hand whose width can be read.");
  }
  robots_.push_back({&*robot, known->read, size()});
  layout_.push_back({owner + "." + field, known->size});
  return true;
}

void Observer::read(double* values) const {
  for (const std::size_t at : times_) {
    values[at] = simulation_->world().time();
  }
  for (const RobotValue& value : robots_) {
    value.read(*value.robot, values + value.at);
  }
  if (bodies_.empty()) {
    return;
  }
  const std::vector<BodyState> states = bodyStates(simulation_->world(), body_names_);
  for (std::size_t i = 0; i < bodies_.size(); i++) {
    double* to = values + bodies_[i].at;
    const auto put = [&to](const auto& array) { to = std::copy(array.begin(), array.end(), to); };
    if (bodies_[i].twist) {
      put(states[i].twist.linear);
      put(states[i].twist.angular);
    } else {
      put(states[i].pose.position);
      put(states[i].pose.orientation);
    }
  }
}

namespace {

/// Ticks of all worlds together between two checks whether a step continues, some 80 ms of a core,
/// and the bounds of those of one world (chosen here).
constexpr std::uint64_t kTicksOfAll = 4000;
constexpr std::uint64_t kMinTicks = 50;
constexpr std::uint64_t kMaxTicks = 1000;

}  // namespace

class SimulationBatch::Threads {
 public:
  explicit Threads(int number) : arena_(std::min(number, tbb::info::default_concurrency())) {}

  /// Calls `function(i)` for each i below `count`.
  template <typename Function>
  void run(std::size_t count, const Function& function) {
    arena_.execute([&] { tbb::parallel_for(std::size_t{0}, count, function); });
  }

 private:
  tbb::task_arena arena_;
};

SimulationBatch::SimulationBatch(std::vector<Simulation*> simulations, int threads,
                                 const std::vector<std::string>& observe)
    : simulations_(std::move(simulations)), process_(getpid()) {
  if (simulations_.empty()) {
    throw std::invalid_argument("A batch needs at least one simulation.");
  }
  if (threads < 1 || threads > kMaxThreads) {
    throw std::invalid_argument("A batch runs on 1 to " + std::to_string(kMaxThreads) +
                                " threads, not on " + std::to_string(threads) + ".");
  }
  for (Simulation* simulation : simulations_) {
    observers_.emplace_back(*simulation, observe);
  }
  row_size_ = observers_[0].size();
  observations_.resize(simulations_.size() * row_size_);
  threads_ = std::make_unique<Threads>(threads);
  this->observe();
}

SimulationBatch::~SimulationBatch() = default;

template <typename Function>
void SimulationBatch::forEach(Faults& faults, const Function& function) {
  if (getpid() != process_) {
    throw std::runtime_error(
        "This batch was made before the process was forked and has no threads here; make one in "
        "the new process.");
  }
  threads_->run(simulations_.size(), [&](std::size_t i) {
    if (!faults[i].empty()) {
      return;
    }
    try {
      function(i);
    } catch (const std::exception& error) {
      faults[i] = error.what();
    }
  });
}

void SimulationBatch::report(const Faults& faults) {
  std::string text;
  for (std::size_t i = 0; i < faults.size(); i++) {
    if (!faults[i].empty()) {
      text += (text.empty() ? "" : " ") + ("World " + std::to_string(i) + ": " + faults[i]);
    }
  }
  if (!text.empty()) {
    throw std::runtime_error(text);
  }
}

void SimulationBatch::advance(std::size_t number, std::uint64_t ticks) {
  const auto see = [&] { observers_[number].read(&observations_[number * row_size_]); };
  try {
    simulations_[number]->step(ticks);
  } catch (...) {
    see();
    throw;
  }
  see();
}

void SimulationBatch::step(std::uint64_t ticks, const std::function<bool()>& keep_stepping) {
  const std::uint64_t part =
      std::clamp<std::uint64_t>(kTicksOfAll / simulations_.size(), kMinTicks, kMaxTicks);
  Faults faults(simulations_.size());
  do {
    const std::uint64_t next = std::min(ticks, part);
    forEach(faults, [&](std::size_t i) { advance(i, next); });
    ticks -= next;
  } while (ticks > 0 && (!keep_stepping || keep_stepping()));
  report(faults);
}

void SimulationBatch::observe() {
  Faults faults(simulations_.size());
  forEach(faults, [this](std::size_t i) { observers_[i].read(&observations_[i * row_size_]); });
  report(faults);
}

void SimulationBatch::replace(std::size_t number, Simulation& simulation) {
  if (number >= simulations_.size()) {
    throw std::invalid_argument("There is no world " + std::to_string(number) + "; the batch has " +
                                std::to_string(simulations_.size()) + ".");
  }
  const auto present = std::find(simulations_.begin(), simulations_.end(), &simulation);
  if (present != simulations_.end()) {
    throw std::invalid_argument("This simulation is already world " +
                                std::to_string(present - simulations_.begin()) + " of the batch.");
  }
  observers_[number] = Observer(simulation, observers_[number].names());
  simulations_[number] = &simulation;
  observers_[number].read(&observations_[number * row_size_]);
}

}  // namespace franka_sim
