// SPDX-License-Identifier: MPL-2.0
// Two translation units with every header each: a function that is not inline would be defined twice.
int first();
int second();

int main() { return first() + second() == 3 ? 0 : 1; }
