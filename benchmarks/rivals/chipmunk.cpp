// Chipmunk 7 on the scenes of scenes.h: rigid bodies in double precision, sequential impulses with --sweeps
// iterations (10) and --slop metres of overlap left alone (5 mm). Usage: see read_options() in measures.h.

#include <chipmunk/chipmunk.h>
#include <chipmunk/chipmunk_structs.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "command_line.h"
#include "rigid_shape.h"

namespace talus::bench {
namespace {

Vec2 to_vec2(cpVect v) { return {v.x, v.y}; }
cpVect to_chipmunk(Vec2 v) { return cpv(v.x, v.y); }

// Shapes and bodies are left to the end of the process: they are needed until then.
class ChipmunkEngine : public BenchEngine {
 public:
  ChipmunkEngine(const BenchScene& scene, int sweeps, double slop)
      : shapes_(rigid_shapes(scene)), sweeps_(sweeps), space_(cpSpaceNew()) {
    cpSpaceSetIterations(space_, sweeps);
    cpSpaceSetCollisionSlop(space_, slop);
    cpSpaceSetSleepTimeThreshold(space_, std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < shapes_.size(); ++i) add_body(i, scene);
  }

  std::string name() const override { return fmt::format("chipmunk-{}", cpVersionString); }
  int sweeps() const override { return sweeps_; }
  void set_gravity(Vec2 gravity) override { cpSpaceSetGravity(space_, to_chipmunk(gravity)); }
  void step(double dt) override { cpSpaceStep(space_, dt); }

  int contact_points() const override {
    int count = 0;
    for (int i = 0; i < space_->arbiters->num; ++i) count += arbiter(i).count;
    return count;
  }

  std::vector<BenchBlock> blocks() const override {
    std::vector<BenchBlock> result;
    for (size_t i = 0; i < shapes_.size(); ++i)
      result.push_back(posed(shapes_[i], to_vec2(cpBodyGetPosition(bodies_[i])), cpBodyGetAngle(bodies_[i])));
    return result;
  }

  std::vector<BenchContact> contacts() const override {
    std::vector<BenchContact> result;
    for (int i = 0; i < space_->arbiters->num; ++i) {
      const cpArbiter& pair = arbiter(i);
      for (int k = 0; k < pair.count; ++k) {
        const cpContact& contact = pair.contacts[k];
        const Vec2 point = to_vec2(cpvadd(pair.body_a->p, contact.r1));
        result.push_back({index_of(pair.body_a), index_of(pair.body_b), point, to_vec2(pair.n), contact.jnAcc,
                          contact.jtAcc,
                          velocity_of(pair.body_b).at(point) - velocity_of(pair.body_a).at(point)});
      }
    }
    return result;
  }

 private:
  void add_body(size_t i, const BenchScene& scene) {
    const RigidShape& shape = shapes_[i];
    cpBody* body = shape.fixed ? cpBodyNewStatic() : cpBodyNew(shape.mass, shape.inertia);
    cpBodySetPosition(body, to_chipmunk(shape.centroid));
    cpBodySetUserData(body, reinterpret_cast<cpDataPointer>(static_cast<uintptr_t>(i)));
    cpSpaceAddBody(space_, body);
    std::vector<cpVect> corners;
    for (const Vec2 corner : shape.corners) corners.push_back(to_chipmunk(corner));
    cpShape* polygon =
        cpPolyShapeNew(body, static_cast<int>(corners.size()), corners.data(), cpTransformIdentity, 0);
    cpShapeSetFriction(polygon, std::sqrt(scene.friction));  // a contact multiplies those of its two shapes
    cpShapeSetElasticity(polygon, 0);
    cpSpaceAddShape(space_, polygon);
    bodies_.push_back(body);
  }

  const cpArbiter& arbiter(int i) const { return *static_cast<const cpArbiter*>(space_->arbiters->arr[i]); }

  static int index_of(const cpBody* body) {
    return static_cast<int>(reinterpret_cast<uintptr_t>(cpBodyGetUserData(body)));
  }

  static RigidVelocity velocity_of(const cpBody* body) {
    return {to_vec2(cpBodyGetPosition(body)), to_vec2(cpBodyGetVelocity(body)),
            cpBodyGetAngularVelocity(body)};
  }

  std::vector<RigidShape> shapes_;
  int sweeps_;
  cpSpace* space_;
  std::vector<cpBody*> bodies_;
};

// The plain space has no threads.
int run(int argc, char** argv) {
  return run_on_one_thread(argc, argv, [](const BenchScene& scene, const BenchOptions& options) {
    return ChipmunkEngine(scene, options.sweeps > 0 ? options.sweeps : 10,
                          std::isnan(options.slop) ? 0.005 : options.slop);
  });
}

}  // namespace
}  // namespace talus::bench

int main(int argc, char** argv) {
  return talus::bench::run_program("rival_chipmunk", talus::bench::run, argc, argv);
}
