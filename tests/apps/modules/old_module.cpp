// A module of another version.
extern "C" {

extern const char loopgrid_module_version[];
const char loopgrid_module_version[] = "0.0.1";

int loopgrid_answer();
int loopgrid_answer() { return 42; }
}
