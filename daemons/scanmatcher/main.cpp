namespace hermes::scanmatcher {
int run(int argc, char **argv); // without its header, which reads much of vectorlib
}

int main(int argc, char **argv) {
    return hermes::scanmatcher::run(argc, argv);
}
