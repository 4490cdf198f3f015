// Box2D 2.4 on the scenes of scenes.h: rigid bodies in single precision, sequential impulses with --sweeps
// velocity iterations (8) and three eighths as many position iterations. Usage: see read_options() in
// measures.h.

#include <box2d/box2d.h>
#include <fmt/format.h>

#include <algorithm>

#include "command_line.h"
#include "rigid_shape.h"

// How it was built, where that was not left to the package.
#ifndef TALUS_RIVAL_BUILD
#define TALUS_RIVAL_BUILD ""
#endif

namespace talus::bench {
namespace {

Vec2 to_double(b2Vec2 v) { return {v.x, v.y}; }
b2Vec2 to_float(Vec2 v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }

class Box2dEngine : public BenchEngine {
 public:
  Box2dEngine(const BenchScene& scene, int sweeps)
      : shapes_(rigid_shapes(scene)), sweeps_(sweeps), world_(b2Vec2(0, static_cast<float>(-kGravity))) {
    world_.SetAllowSleeping(false);
    world_.SetContinuousPhysics(false);
    for (size_t i = 0; i < shapes_.size(); ++i) add_body(i, scene);
  }

  std::string name() const override {
    // the last digit is not kept up
    return fmt::format("box2d-{}.{}{}", b2_version.major, b2_version.minor, TALUS_RIVAL_BUILD);
  }
  int sweeps() const override { return sweeps_; }
  void set_gravity(Vec2 gravity) override { world_.SetGravity(to_float(gravity)); }
  void step(double dt) override {
    world_.Step(static_cast<float>(dt), sweeps_, std::max(1, sweeps_ * 3 / 8));
  }

  int contact_points() const override {
    int count = 0;
    for (const b2Contact* c = world_.GetContactList(); c != nullptr; c = c->GetNext())
      if (c->IsTouching()) count += c->GetManifold()->pointCount;
    return count;
  }

  std::vector<BenchBlock> blocks() const override {
    std::vector<BenchBlock> result;
    for (size_t i = 0; i < shapes_.size(); ++i)
      result.push_back(posed(shapes_[i], to_double(bodies_[i]->GetPosition()), bodies_[i]->GetAngle()));
    return result;
  }

  std::vector<BenchContact> contacts() const override {
    std::vector<BenchContact> result;
    for (const b2Contact* c = world_.GetContactList(); c != nullptr; c = c->GetNext()) {
      if (!c->IsTouching()) continue;
      const b2Body &a = *c->GetFixtureA()->GetBody(), &b = *c->GetFixtureB()->GetBody();
      b2WorldManifold manifold;
      c->GetWorldManifold(&manifold);
      for (int k = 0; k < c->GetManifold()->pointCount; ++k) {
        const b2ManifoldPoint& impulses = c->GetManifold()->points[k];
        const Vec2 point = to_double(manifold.points[k]);
        // Box2D's tangent is the normal turned right
        result.push_back({index_of(a), index_of(b), point, to_double(manifold.normal), impulses.normalImpulse,
                          -impulses.tangentImpulse, velocity_of(b).at(point) - velocity_of(a).at(point)});
      }
    }
    return result;
  }

 private:
  void add_body(size_t i, const BenchScene& scene) {
    const RigidShape& shape = shapes_[i];
    b2BodyDef body;
    body.type = shape.fixed ? b2_staticBody : b2_dynamicBody;
    body.position = to_float(shape.centroid);
    body.userData.pointer = i;
    std::vector<b2Vec2> corners;
    for (const Vec2 corner : shape.corners) corners.push_back(to_float(corner));
    b2PolygonShape polygon;
    polygon.Set(corners.data(), static_cast<int32>(corners.size()));
    polygon.m_radius = 0;  // the skin of 1 cm that is meant for games would hold the blocks apart
    b2FixtureDef fixture;
    fixture.shape = &polygon;
    fixture.density = static_cast<float>(scene.density);
    fixture.friction = static_cast<float>(scene.friction);
    fixture.restitution = 0;
    bodies_.push_back(world_.CreateBody(&body));
    bodies_.back()->CreateFixture(&fixture);
  }

  static int index_of(const b2Body& body) {
    return static_cast<int>(const_cast<b2Body&>(body).GetUserData().pointer);  // its getter is not const
  }

  static RigidVelocity velocity_of(const b2Body& body) {
    return {to_double(body.GetWorldCenter()), to_double(body.GetLinearVelocity()), body.GetAngularVelocity()};
  }

  std::vector<RigidShape> shapes_;
  int sweeps_;
  b2World world_;
  std::vector<b2Body*> bodies_;  // owned by world_
};

}  // namespace
}  // namespace talus::bench

int main(int argc, char** argv) {
  using namespace talus::bench;
  return run_rival<Box2dEngine, 8>("rival_box2d", argc, argv);
}
