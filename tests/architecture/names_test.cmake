# cmake -D ROOT=... -D SCRATCH=... -D CLANG_TIDY=... -P names_test.cmake
# Checks that the naming rules of .clang-tidy catch wrong names: plants one of each kind.
cmake_minimum_required(VERSION 3.25)

set(right [=[
#define PALPATE_SQUARE(x) ((x) * (x))
namespace palpate {
inline constexpr double kPi = 3.14159;
enum class Color { kRed, kGreen };
using Number = double;
struct PlainValue {
  double side_length = 1.0;
};
class SmoothBall {
 public:
  explicit SmoothBall(double radius) : radius_(radius) {}
  [[nodiscard]] double area(double hip_W) const noexcept {
    const double square_root = hip_W;
    return kPi * PALPATE_SQUARE(radius_) * square_root;
  }

 private:
  double radius_;
};
}  // namespace palpate
]=])

function(tidy text status_out output_out)
  file(WRITE "${SCRATCH}/names.cpp" "${text}")
  execute_process(COMMAND ${CLANG_TIDY} --quiet --config-file=${ROOT}/.clang-tidy
      "--checks=-*,readability-identifier-naming" ${SCRATCH}/names.cpp -- -std=c++20
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  set(${status_out} "${status}" PARENT_SCOPE)
  set(${output_out} "${output}" PARENT_SCOPE)
endfunction()

tidy("${right}" status output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "right names are refused:\n${output}")
endif()

foreach(change
    "PALPATE_SQUARE=SQUARE" "namespace palpate=namespace Palpate" "kPi=PI" "Color=color" "kRed=RED"
    "Number=number_type" "PlainValue=plain_value" "side_length=sideLength" "SmoothBall=smooth_ball" "area=Area"
    "square_root=squareRoot" "radius_=m_radius" "double hip_W=double hipW")
  string(REGEX MATCH "^(.*)=(.*)$" all "${change}")
  set(good "${CMAKE_MATCH_1}")
  set(bad "${CMAKE_MATCH_2}")
  string(REPLACE "${good}" "${bad}" text "${right}")
  string(REGEX REPLACE ".* " "" name "${bad}")
  tidy("${text}" status output)
  if(status EQUAL 0 OR NOT output MATCHES "invalid case style[^\n]*'${name}'")
    message(SEND_ERROR "'${name}' in place of '${good}' is not caught:\n${output}")
  endif()
endforeach()
