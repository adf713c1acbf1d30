#include "run_command.h"

int main(int argc, char** argv) {
  return palpate::tools::runCommand(std::vector<std::string>(argv + 1, argv + argc));
}
