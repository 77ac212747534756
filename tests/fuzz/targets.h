// What is done with the bytes of a hostile file, once per reader of Gnomon's own. libFuzzer calls
// these (libfuzzer_entry.cpp), and corpus_test.cpp over the files of tests/fuzz/corpus/<target>/.
#pragma once

#include <string_view>

namespace gnomon::fuzz {

// Each returns where the reader reads or refuses the bytes; throws Finding (check.h) where what it
// gives breaks a promise of its header. Everything else that a program dies of is a finding, too.
void cityjson(std::string_view bytes);
void obj(std::string_view bytes);
// GeoJSON. An odd first byte: the scene has no CRS yet; an even one: it is in EPSG:25832.
void footprints(std::string_view bytes);
// The first byte is the reader: '0' STL, '1' PLY, '2' OFF, '3' glTF (modulo 4), at rest, posed and
// as a rig. What follows as an MD2 does is one, whatever the first byte.
void mesh(std::string_view bytes);
// The place of an IFC file.
void step(std::string_view bytes);

}  // namespace gnomon::fuzz
