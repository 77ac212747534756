// Files of ISO 10303-21 ("STEP physical files", what IFC is written in): entity instances by id.
// Based on: ISO 10303-21, Clear text encoding of the exchange structure, editions 2 and 3.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <gnomon/core/result.h>

namespace gnomon {

struct StepValue {
  enum class Kind {
    kNull,         // $, not given
    kDerived,      // *
    kNumber,       // integer or real: number
    kString,       // text, decoded to UTF-8
    kEnumeration,  // .ELEMENT.: text is "ELEMENT"
    kBinary,       // "0FF": text as written
    kReference,    // #12: reference
    kList,         // items
    kTyped,        // IFCLABEL('x'): text is the keyword, items its arguments
  };
  Kind kind = Kind::kNull;
  double number = 0;
  std::uint64_t reference = 0;
  std::string text = {};
  std::vector<StepValue> items = {};
};

// #12=IFCWALL(...); Views into the file's text.
struct StepInstance {
  std::uint64_t id = 0;        // 0 in the header
  std::string_view keyword;    // as written ("IFCWALL"); empty for the rare #1=(A(...)B(...))
  std::string_view arguments;  // "(...)", checked: each token is well-formed
};

struct StepFile {
  std::string path;
  std::string_view text;                // must outlive the StepFile
  std::vector<std::string> schemas;     // of FILE_SCHEMA: "IFC2X3"
  std::vector<StepInstance> instances;  // of all data sections, in the order of the file
  std::unordered_map<std::uint64_t, std::uint32_t> index;  // id -> index into instances
};

// Reads and checks the whole file, down to each token, without building its values: a large file
// costs little memory. Errors (with the line): no STEP file, cut off, anything that the grammar
// does not know, an id twice, numbers that are not finite, lists nested deeper than 100.
Result<StepFile> read_step(std::string_view text, const std::string& path);

// The instance with this id; null where the file has none.
const StepInstance* find(const StepFile& file, std::uint64_t id);

// The arguments, in order. For a complex instance, one kTyped per part.
// Strings: '' is ', \\ is \, \S\, \X\, \X2\ and \X4\ are decoded; other backslashes, which careless
// programs write in paths, stay. Bytes that are not UTF-8 are taken for ISO 8859-1. Line breaks in
// strings are layout and fall away.
std::vector<StepValue> arguments_of(const StepInstance& instance);

// Ids that the arguments refer to, at any depth, appended in order.
void references_of(const StepInstance& instance, std::vector<std::uint64_t>& ids);

// Keywords are upper case; some programs write them otherwise.
bool same_keyword(std::string_view a, std::string_view b);

// "house.ifc: line 17: " of an instance, for messages.
std::string where(const StepFile& file, const StepInstance& instance);

}  // namespace gnomon
