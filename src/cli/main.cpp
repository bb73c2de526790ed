// credence: can a filter's covariance be believed?

#include <credence/program.hpp>

int main(int argc, char** argv) { return credence::program(argc, argv); }
