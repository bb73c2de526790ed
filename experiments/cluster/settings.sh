# The settings of the study: edit this file, or set the variables in the environment of submit.sh. Paths are relative to
# the folder in which submit.sh is called. Sourced by the scripts here.
: "${STUDY:=experiments/seed/*.ini}"          # scenario files
: "${TRIALS:=1e6}"                            # of each scenario
: "${SEED:=1}"
: "${SHARDS:=8}"                              # tasks of the array
: "${OUTPUT:=results/study.h5}"               # the results file; its parts go to $OUTPUT.parts/
: "${CREDENCE:=build/credence}"               # the program
: "${OPTIONS:=}"                              # further options of credence run, such as --set noise.heading=0.01
: "${RESTARTS:=100}"                          # how often a task may be put back into the queue
export STUDY TRIALS SEED SHARDS OUTPUT CREDENCE OPTIONS RESTARTS
