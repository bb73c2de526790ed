#pragma once
// The attributes of a record that name component groups, groups of innovation rows, and components.

#include "record/source.hpp"
#include "record/step.hpp"

#include <string>
#include <vector>

namespace credence {

/// The whole state as `all`, then the component groups, such as `position 0 2, velocity 1 3, heading 4`, with ranges
/// such as `0:3` between them, of a state of n components. Throws RecordError at `place`, as all functions here.
std::vector<ComponentGroup> parse_groups(const ListEntries& entries, int n, const std::string& place);

/// A group of one component or more: contiguous where they are so, and in order.
ComponentGroup group_of(const std::string& name, std::vector<int> members);

/// Groups of the m rows of an innovation, such as `gps 0:3, baro 3`.
std::vector<RowGroup> parse_row_groups(const ListEntries& entries, int m, const std::string& place);

/// The component groups of a record, of the attribute `groups`.
std::vector<ComponentGroup> read_groups(const RecordSource& source, int n);

/// Names and units of the n components by the attributes `component_names` and `component_units`; without both,
/// `defaults` (n, or empty). Without names they are those of `defaults`, or x0, x1 ...; of names without units, the
/// units are empty.
std::vector<Component> read_components(const RecordSource& source, int n, const std::vector<Component>& defaults);

/// Throw where a name cannot be that of a group of components, which is a word, or that of a component.
void require_group_name(const std::string& name, const std::string& place);
void require_component_name(const std::string& name, const std::string& place);

}  // namespace credence
