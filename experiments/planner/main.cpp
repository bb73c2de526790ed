// The program credence with one more planner, that of curious.hpp.

#include "curious.hpp"

#include <credence/program.hpp>

CREDENCE_PLANNER(Curious);

int main(int argc, char** argv) { return credence::program(argc, argv); }
