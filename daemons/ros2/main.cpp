#include "daemons/ros2/Ros2.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::ros2::Ros2>(argc, argv);
}
