// The program credence with one more world, the tracker of tracker.hpp.

#include "tracker.hpp"

#include <credence/program.hpp>

int main(int argc, char** argv) {
    credence::add_own_world<Tracker>();
    return credence::program(argc, argv);
}
