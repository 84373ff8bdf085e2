// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/world.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <string>

#include "sim/environment/mujoco_model.hpp"

namespace aims {
namespace {

constexpr double kHighestBump = 0.02;  ///< of a floor with bumps [m]

int id_of(const mjModel* model, mjtObj type, const std::string& name) {
  return mj_name2id(model, type, name.c_str());
}

Eigen::Vector3d vector_at(const mjtNum* data) { return {data[0], data[1], data[2]}; }

Eigen::Quaterniond quaternion_at(const mjtNum* data) {
  return Eigen::Quaterniond(data[0], data[1], data[2], data[3]);
}

}  // namespace

JointVector standing_joints(const LegGeometry& legs, double height, double lateral) {
  JointVector q;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d foot =
        hip_in_base(leg, legs) + Eigen::Vector3d(0.0, side_of(leg) * lateral, -height);
    q.segment<3>(3 * leg) = leg_angles(leg, foot, legs);
  }
  return q;
}

struct World::Impl {
  MujocoModel model;
  MujocoData data;
  Duration timestep = 0;
  int trunk = -1;
  std::array<int, kLegCount> foot_geom{};
  std::array<int, kLegCount> calf_body{};
  LegGeometries legs;
  double body_height = 0.0;   ///< at the start [m]
  double stance_width = 0.0;  ///< at the start [m]
  BodyModel body;
  RobotState state;

  Result<void> find_parts();
  void set_options(const WorldSetup& setup);
  /// Dimensions of a leg in the model.
  LegGeometry leg_in_model(int leg) const;
  /// The dimensions of the robot as built; constants of the model that follow from them.
  void set_legs(const LegGeometries& built);
  void put(double x, double y, double z, double yaw);
  /// Height [m] of the grid point of the floor nearest to (x, y).
  double field_height(double x, double y) const;
  void measure_body();
  void read_motion();
  void read_contacts();
  void read_contact(const mjContact& contact, int index);
  bool is_floor(int geom) const;
  int leg_of_calf(int body_id) const;
};

Result<void> World::Impl::find_parts() {
  const mjModel* m = model.get();
  trunk = id_of(m, mjOBJ_BODY, "trunk");
  if (trunk < 0 || m->nq != 7 + kJointCount || m->nu != kJointCount) {
    return failure("physics model: expected one quadruped with body 'trunk' and 12 motors");
  }
  for (int leg = 0; leg < kLegCount; ++leg) {
    foot_geom[leg] = id_of(m, mjOBJ_GEOM, std::string(kLegNames[leg]) + "_foot");
    if (foot_geom[leg] < 0) return failure("physics model: a foot of the quadruped is missing");
    calf_body[leg] = m->geom_bodyid[foot_geom[leg]];
  }
  return {};
}

void World::Impl::set_options(const WorldSetup& setup) {
  mjOption& option = model->opt;
  option.timestep = setup.timestep;
  option.integrator = mjINT_EULER;
  option.solver = mjSOL_NEWTON;
  option.cone = mjCONE_ELLIPTIC;
  option.impratio = 10.0;
  timestep = from_seconds(setup.timestep);
  for (const int geom : foot_geom) model->geom_friction[3 * geom] = setup.friction;
}

LegGeometry World::Impl::leg_in_model(int leg) const {
  const mjModel* m = model.get();
  const int calf = calf_body[leg];
  const int thigh = m->body_parentid[calf];
  const int hip = m->body_parentid[thigh];
  const int foot = foot_geom[leg];
  return {.hip_x = std::abs(m->body_pos[3 * hip]),
          .hip_y = std::abs(m->body_pos[3 * hip + 1]),
          .abduction = std::abs(m->body_pos[3 * thigh + 1]),
          .thigh = -m->body_pos[3 * calf + 2],
          .calf = -m->geom_pos[3 * foot + 2],
          .foot_radius = m->geom_size[3 * foot]};
}

void World::Impl::set_legs(const LegGeometries& built) {
  legs = built;
  bool as_in_model = true;
  for (int leg = 0; leg < kLegCount; ++leg) {
    as_in_model = as_in_model && built[leg] == leg_in_model(leg);
  }
  if (as_in_model) return;
  mjModel* m = model.get();
  for (int leg = 0; leg < kLegCount; ++leg) {
    const LegGeometry& as_built = built[leg];
    const int calf = calf_body[leg];
    const int thigh = m->body_parentid[calf];
    const Eigen::Vector3d at_hip = hip_in_base(leg, as_built);
    std::copy_n(at_hip.data(), 2, m->body_pos + 3 * m->body_parentid[thigh]);
    m->body_pos[3 * thigh + 1] = side_of(leg) * as_built.abduction;
    m->body_pos[3 * calf + 2] = -as_built.thigh;
    m->geom_pos[3 * foot_geom[leg] + 2] = -as_built.calf;
    m->geom_size[3 * foot_geom[leg]] = as_built.foot_radius;
    m->geom_rbound[foot_geom[leg]] = as_built.foot_radius;
    const int foot_site = id_of(m, mjOBJ_SITE, std::string(kLegNames[leg]) + "_foot");
    if (foot_site >= 0) m->site_pos[3 * foot_site + 2] = -as_built.calf;
  }
  mj_setConst(m, data.get());
}

double World::Impl::field_height(double x, double y) const {
  if (model->nhfield == 0) return 0.0;
  const mjtNum* size = model->hfield_size;
  int geom = 0;
  while (model->geom_type[geom] != mjGEOM_HFIELD) ++geom;
  const mjtNum* centre = model->geom_pos + 3 * geom;
  const auto cell = [](double offset, double half, int points) {
    const double fraction = std::clamp((offset + half) / (2.0 * half), 0.0, 1.0);
    return static_cast<int>(std::lround(fraction * (points - 1)));
  };
  const int column = cell(x - centre[0], size[0], model->hfield_ncol[0]);
  const int row = cell(y - centre[1], size[1], model->hfield_nrow[0]);
  return size[2] * static_cast<double>(model->hfield_data[row * model->hfield_ncol[0] + column]);
}

void World::Impl::put(double x, double y, double z, double yaw) {
  mj_resetData(model.get(), data.get());
  const Eigen::Quaterniond q = yaw_rotation(yaw);
  const std::array<double, 7> root = {x, y, z, q.w(), q.x(), q.y(), q.z()};
  std::copy(root.begin(), root.end(), data->qpos);
  const JointVector joints =
      standing_joints(body.legs, body_height - body.legs.foot_radius, stance_width);
  std::copy(joints.begin(), joints.end(), data->qpos + 7);
  mj_forward(model.get(), data.get());
}

/// Total mass, centre of mass and inertia, from the free joint's block of the mass matrix.
void World::Impl::measure_body() {
  put(0.0, 0.0, body_height, 0.0);
  const int nv = model->nv;
  std::vector<mjtNum> full(static_cast<std::size_t>(nv) * nv);
  mj_fullM(model.get(), full.data(), data->qM);
  body.mass = model->body_subtreemass[trunk];
  body.com_in_base = vector_at(data->subtree_com + 3 * trunk) - vector_at(data->qpos);
  Eigen::Matrix3d about_base;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) about_base(i, j) = full[(3 + i) * nv + 3 + j];
  }
  const Eigen::Matrix3d lever = hat(body.com_in_base);
  body.inertia = about_base + body.mass * lever * lever;
}

void World::Impl::read_motion() {
  const mjtNum* qpos = data->qpos;
  const mjtNum* qvel = data->qvel;
  state.T_world_base.translation = vector_at(qpos);
  state.T_world_base.rotation = quaternion_at(qpos + 3).normalized();
  state.velocity = vector_at(qvel);
  state.angular_velocity = vector_at(qvel + 3);
  state.q = Eigen::Map<const JointVector>(qpos + 7);
  state.qd = Eigen::Map<const JointVector>(qvel + 6);
}

bool World::Impl::is_floor(int geom) const {
  const int type = model->geom_type[geom];
  return type == mjGEOM_PLANE || type == mjGEOM_HFIELD;
}

int World::Impl::leg_of_calf(int body_id) const {
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (calf_body[leg] == body_id) return leg;
  }
  return -1;
}

void World::Impl::read_contact(const mjContact& contact, int index) {
  const bool first_is_static = model->geom_bodyid[contact.geom1] == 0;
  const int world_geom = first_is_static ? contact.geom1 : contact.geom2;
  const int robot_geom = first_is_static ? contact.geom2 : contact.geom1;
  if (!is_floor(world_geom)) {
    state.touches_wall = true;
    return;
  }
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (foot_geom[leg] != robot_geom) continue;
    std::array<mjtNum, 6> force{};
    mj_contactForce(model.get(), data.get(), index, force.data());
    state.foot_load[leg] += force[0];
    // The rows of the frame are the contact's axes; its force is the one on the second body.
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(contact.frame);
    const Eigen::Vector3d on_second = axes.transpose() * vector_at(force.data());
    state.foot_force[leg] += first_is_static ? on_second : Eigen::Vector3d(-on_second);
    return;
  }
  if (leg_of_calf(model->geom_bodyid[robot_geom]) < 0) state.trunk_on_floor = true;
}

/// Contacts belong to the step that led to the present state.
void World::Impl::read_contacts() {
  state.foot_load.fill(0.0);
  state.foot_force.fill(Eigen::Vector3d::Zero());
  state.touches_wall = false;
  state.trunk_on_floor = false;
  for (int i = 0; i < data->ncon; ++i) read_contact(data->contact[i], i);
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

Result<World> World::create(const WorldSetup& setup) {
  auto model = load_mujoco_model(setup.mjcf, setup.heights);
  if (!model) return tl::unexpected(model.error());
  auto impl = std::make_unique<Impl>();
  impl->model = std::move(*model);
  if (auto found = impl->find_parts(); !found) return tl::unexpected(found.error());
  impl->set_options(setup);
  impl->data.reset(mj_makeData(impl->model.get()));
  impl->body.legs = setup.drawn;
  impl->body_height = setup.body_height;
  impl->stance_width = setup.stance_width;
  impl->set_legs(setup.legs);
  impl->measure_body();
  World world(std::move(impl));
  world.place(0.0, 0.0, 0.0);
  return world;
}

void World::place(double x, double y, double yaw) {
  // Lifted step by step until no foot is inside a bump of the floor; a ramp is higher than that.
  double z = impl_->body_height + std::max(0.0, impl_->field_height(x, y) - kHighestBump);
  impl_->put(x, y, z, yaw);
  for (int lift = 0; lift < 20; ++lift) {
    bool sunk = false;
    for (int i = 0; i < impl_->data->ncon; ++i) {
      const mjContact& contact = impl_->data->contact[i];
      const bool on_floor = impl_->is_floor(contact.geom1) || impl_->is_floor(contact.geom2);
      sunk = sunk || (on_floor && contact.dist < -1e-4);
    }
    if (!sunk) break;
    z += 0.002;
    impl_->put(x, y, z, yaw);
  }
  impl_->state = RobotState{};
  impl_->read_motion();
  impl_->read_contacts();
}

void World::step(const JointVector& torques) {
  mjData* data = impl_->data.get();
  for (int i = 0; i < kJointCount; ++i) data->ctrl[i] = torques[i];
  mj_step(impl_->model.get(), data);
  impl_->state.stamp += impl_->timestep;
  impl_->read_motion();
  impl_->read_contacts();
}

void World::restart_clock() { impl_->state.stamp = 0; }

void World::push(const Eigen::Vector3d& force) {
  Eigen::Map<Eigen::Vector3d>(impl_->data->xfrc_applied + 6 * impl_->trunk) = force;
}

const RobotState& World::state() const { return impl_->state; }
Duration World::timestep() const { return impl_->timestep; }
const BodyModel& World::body() const { return impl_->body; }

Pose World::T_base_site(std::string_view site) const {
  const mjModel* m = impl_->model.get();
  const int id = id_of(m, mjOBJ_SITE, std::string(site));
  if (id < 0 || m->site_bodyid[id] != impl_->trunk) return {};
  return {quaternion_at(m->site_quat + 4 * id), vector_at(m->site_pos + 3 * id)};
}

std::array<double, kLegCount> World::slip_speed() const {
  const RobotState& s = impl_->state;
  std::array<double, kLegCount> speed{};
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (s.foot_load[leg] <= 0.0) continue;
    const Eigen::Vector3d q = joints_of(s.q, leg);
    const Eigen::Vector3d rate = joints_of(s.qd, leg);
    const Eigen::Vector3d turning = s.angular_velocity + calf_rate_in_base(q, rate);
    const Eigen::Vector3d in_base =
        s.angular_velocity.cross(foot_in_base(leg, q, impl_->legs[leg])) +
        foot_jacobian(leg, q, impl_->legs[leg]) * rate;
    const Eigen::Vector3d down(0.0, 0.0, -impl_->legs[leg].foot_radius);
    const Eigen::Quaterniond& R = s.T_world_base.rotation;
    const Eigen::Vector3d patch = s.velocity + R * in_base + (R * turning).cross(down);
    speed[leg] = patch.head<2>().norm();
  }
  return speed;
}

bool World::robot_inside_solid() const {
  for (int i = 0; i < impl_->data->ncon; ++i) {
    const mjContact& contact = impl_->data->contact[i];
    if (!impl_->is_floor(contact.geom1) && !impl_->is_floor(contact.geom2)) return true;
  }
  return false;
}

std::vector<double> World::qpos() const {
  return {impl_->data->qpos, impl_->data->qpos + impl_->model->nq};
}

int World::warning_count() const {
  int count = 0;
  for (const mjWarningStat& warning : impl_->data->warning) count += warning.number;
  return count;
}

}  // namespace aims
