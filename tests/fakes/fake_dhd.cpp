// Stands in for Force Dimension's libdhd.so: it returns values that a test sets, and records the
// calls.

#include <algorithm>
#include <array>

struct Fake {
  std::array<double, 3> position;
  std::array<double, 3> velocity;
  std::array<double, 3> force;
  int button;
  int answer;      // return value of dhdGetPosition
  int set_answer;  // return value of dhdSetForce
  int is_absent;
  int is_open;
  int force_is_enabled;
};

namespace {

Fake fake{};

}  // namespace

extern "C" {
Fake* fakeState() { return &fake; }

int dhdOpen() {
  if (fake.is_absent != 0) return -1;
  fake.is_open = 1;
  return 0;
}
int dhdClose(char) {
  fake.is_open = 0;
  return 0;
}
int dhdEnableForce(unsigned char value, char) {
  fake.force_is_enabled = value;
  return 0;
}
int dhdGetPosition(double* x, double* y, double* z, char) {
  *x = fake.position[0];
  *y = fake.position[1];
  *z = fake.position[2];
  return fake.answer;
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char) {
  *x = fake.velocity[0];
  *y = fake.velocity[1];
  *z = fake.velocity[2];
  return 0;
}
int dhdGetButton(int, char) { return fake.button; }
int dhdSetForce(double x, double y, double z, char) {
  fake.force = {x, y, z};
  return fake.set_answer;
}
const char* dhdGetSystemName(char) { return "omega.3"; }
const char* dhdErrorGetLastStr() { return "no device found"; }
}
