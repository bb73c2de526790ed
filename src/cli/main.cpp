// The program credence, which tests whether a filter's covariance can be believed: main() and the list of subcommands.

#include <credence/program.hpp>

int main(int argc, char** argv) { return credence::program(argc, argv); }
