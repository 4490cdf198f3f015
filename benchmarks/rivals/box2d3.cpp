// Box2D 3 on the scenes of scenes.h: rigid bodies in single precision, soft contacts in --sweeps substeps (4) of
// each step. Usage: see read_options() in measures.h.

#include <box2d/box2d.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "command_line.h"
#include "rigid_shape.h"

namespace talus::bench {
namespace {

// Stiffness of its soft contacts as a frequency [1/s]. Made for games it is 30; the least overlap and drift of
// the walls come with this (it is held below an eighth of the rate of substeps in any case).
constexpr float kContactHertz = 1000;

Vec2 to_double(b2Vec2 v) { return {v.x, v.y}; }
b2Vec2 to_float(Vec2 v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }

class Box2d3Engine : public BenchEngine {
 public:
  Box2d3Engine(const BenchScene& scene, int substeps) : shapes_(rigid_shapes(scene)), substeps_(substeps) {
    b2WorldDef def = b2DefaultWorldDef();
    def.gravity = {0, static_cast<float>(-kGravity)};
    def.enableSleep = false, def.enableContinuous = false;
    def.contactHertz = kContactHertz;
    def.workerCount = 1;
    world_ = b2CreateWorld(&def);
    for (size_t i = 0; i < shapes_.size(); ++i) add_body(i, scene);
  }
  ~Box2d3Engine() override { b2DestroyWorld(world_); }
  Box2d3Engine(const Box2d3Engine&) = delete;
  Box2d3Engine& operator=(const Box2d3Engine&) = delete;

  std::string name() const override {
    const b2Version v = b2GetVersion();
    return fmt::format("box2d-{}.{}", v.major, v.minor);
  }
  int sweeps() const override { return substeps_; }
  void set_gravity(Vec2 gravity) override { b2World_SetGravity(world_, to_float(gravity)); }
  void step(double dt) override { b2World_Step(world_, static_cast<float>(dt), substeps_); }
  double impulse_time(double dt) const override { return dt / substeps_; }

  int contact_points() const override {
    int count = 0;
    for_each_contact([&](const b2ContactData& c) { count += c.manifold.pointCount; });
    return count;
  }

  std::vector<BenchBlock> blocks() const override {
    std::vector<BenchBlock> result;
    for (size_t i = 0; i < shapes_.size(); ++i) {
      const b2Rot turn = b2Body_GetRotation(bodies_[i]);
      result.push_back(
          posed(shapes_[i], to_double(b2Body_GetPosition(bodies_[i])), std::atan2(turn.s, turn.c)));
    }
    return result;
  }

  std::vector<BenchContact> contacts() const override {
    std::vector<BenchContact> result;
    for_each_contact([&](const b2ContactData& c) {
      const b2BodyId a = b2Shape_GetBody(c.shapeIdA), b = b2Shape_GetBody(c.shapeIdB);
      for (int k = 0; k < c.manifold.pointCount; ++k) {
        const b2ManifoldPoint& p = c.manifold.points[k];
        const Vec2 point = to_double(b2Body_GetWorldCenter(a)) + to_double(p.anchorA);
        // its tangent is the normal turned right
        result.push_back({index_of(a), index_of(b), point, to_double(c.manifold.normal), p.normalImpulse,
                          -p.tangentImpulse, velocity_of(b).at(point) - velocity_of(a).at(point)});
      }
    });
    return result;
  }

 private:
  void add_body(size_t i, const BenchScene& scene) {
    const RigidShape& shape = shapes_[i];
    b2BodyDef body = b2DefaultBodyDef();
    body.type = shape.fixed ? b2_staticBody : b2_dynamicBody;
    body.position = to_float(shape.centroid);
    bodies_.push_back(b2CreateBody(world_, &body));
    index_.push_back(bodies_.back().index1);
    std::vector<b2Vec2> corners;
    for (const Vec2 corner : shape.corners) corners.push_back(to_float(corner));
    const b2Hull hull = b2ComputeHull(corners.data(), static_cast<int>(corners.size()));
    const b2Polygon polygon = b2MakePolygon(&hull, 0);
    b2ShapeDef def = b2DefaultShapeDef();
    def.density = static_cast<float>(scene.density);
    def.material.friction = static_cast<float>(scene.friction);
    def.material.restitution = 0;
    b2CreatePolygonShape(bodies_.back(), &def, &polygon);
  }

  // Every contact once, as the first of its two bodies lists it.
  template <class F>
  void for_each_contact(F f) const {
    std::vector<b2ContactData> data;
    for (const b2BodyId body : bodies_) {
      data.resize(b2Body_GetContactCapacity(body));
      const int count = b2Body_GetContactData(body, data.data(), static_cast<int>(data.size()));
      for (int k = 0; k < count; ++k) {
        const b2ContactData& c = data[static_cast<size_t>(k)];
        if (b2Shape_GetBody(c.shapeIdA).index1 == body.index1) f(c);
      }
    }
  }

  // Bodies are numbered in the order in which they were made.
  int index_of(b2BodyId body) const {
    return static_cast<int>(std::lower_bound(index_.begin(), index_.end(), body.index1) - index_.begin());
  }

  static RigidVelocity velocity_of(b2BodyId body) {
    return {to_double(b2Body_GetWorldCenter(body)), to_double(b2Body_GetLinearVelocity(body)),
            b2Body_GetAngularVelocity(body)};
  }

  std::vector<RigidShape> shapes_;
  int substeps_;
  b2WorldId world_{};
  std::vector<b2BodyId> bodies_;
  std::vector<int32_t> index_;
};

}  // namespace
}  // namespace talus::bench

int main(int argc, char** argv) {
  using namespace talus::bench;
  return run_rival<Box2d3Engine, 4>("rival_box2d3", argc, argv);
}
