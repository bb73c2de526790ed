// The program credence with the worlds of this folder.

#include "attitude.hpp"
#include "bearings_only.hpp"
#include "coordinated_turn.hpp"
#include "ins.hpp"
#include "polygon.hpp"
#include "robot.hpp"

#include <credence/program.hpp>

int main(int argc, char** argv) {
    credence::add_own_world<Attitude>();
    credence::add_own_world<BearingsOnly>();
    credence::add_own_world<CoordinatedTurn>();
    credence::add_own_world<Ins>();
    credence::add_own_world<Polygon>();
    credence::add_own_world<Robot>();
    return credence::program(argc, argv);
}
