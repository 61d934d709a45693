// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

/// Published stopping powers, mass collision stopping power in MeV cm2/g against kinetic energy in MeV.
namespace reference {

struct stopping_power {
  double kinetic_energy;
  double value;
};

// Muons, "Ionization" column. Groom, Mokhov, Striganov, At. Data Nucl. Data Tables 78 (2001) 183, in the edition of
// pdg.lbl.gov/2021/AtomicNuclearProperties: aluminium.
inline constexpr std::array muon_in_aluminium{
    stopping_power{10, 6.188},  stopping_power{14, 4.849},  stopping_power{20, 3.802},  stopping_power{30, 2.960},  stopping_power{40, 2.533},
    stopping_power{60, 2.110},  stopping_power{80, 1.908},  stopping_power{100, 1.797}, stopping_power{140, 1.688}, stopping_power{200, 1.629},
    stopping_power{300, 1.616}, stopping_power{500, 1.650}, stopping_power{1e3, 1.744}, stopping_power{1e4, 2.097}, stopping_power{1e5, 2.360},
};
// The same, edition 2022 and 2024: liquid hydrogen, helium.
inline constexpr std::array muon_in_liquid_hydrogen{stopping_power{40, 6.539}, stopping_power{1e3, 4.182}, stopping_power{1e4, 4.777},
                                                    stopping_power{1e5, 5.305}};
inline constexpr std::array muon_in_helium{stopping_power{40, 3.082}, stopping_power{100, 2.165}, stopping_power{1e3, 2.133}, stopping_power{1e4, 2.768},
                                           stopping_power{1e5, 3.188}};
// Muons, computed by PUMAS 1.00 with the same inputs (niess/pumas-materials, dedx/muon): the other media. Lithium hydride only above
// 70 MeV: that table takes x0 = +0.0988 for -0.0988, which shows in its delta between 30 and 70 MeV.
inline constexpr std::array muon_in_polystyrene{
    stopping_power{10, 7.802},  stopping_power{20, 4.749},  stopping_power{40, 3.144},  stopping_power{80, 2.359},  stopping_power{100, 2.210},
    stopping_power{140, 2.058}, stopping_power{200, 1.970}, stopping_power{300, 1.937}, stopping_power{1e3, 2.048}, stopping_power{1e4, 2.414},
};
inline constexpr std::array muon_in_mylar{stopping_power{10, 7.420},  stopping_power{40, 2.997},  stopping_power{100, 2.108},
                                          stopping_power{200, 1.880}, stopping_power{1e3, 1.958}, stopping_power{1e4, 2.316}};
inline constexpr std::array muon_in_air{stopping_power{10, 7.039},  stopping_power{40, 2.847},  stopping_power{100, 2.013},
                                        stopping_power{200, 1.827}, stopping_power{1e3, 2.020}, stopping_power{1e4, 2.627}};
inline constexpr std::array muon_in_lithium_hydride{stopping_power{80, 2.336},  stopping_power{100, 2.186}, stopping_power{200, 1.939},
                                                    stopping_power{300, 1.899}, stopping_power{1e3, 1.979}, stopping_power{1e4, 2.285}};

// Protons, NIST PSTAR (Berger, Coursey, Zucker, Chang, NISTIR 4999), total stopping power.
inline constexpr std::array proton_in_mylar{stopping_power{10, 42.47},  stopping_power{50, 11.59},  stopping_power{100, 6.791}, stopping_power{200, 4.187},
                                            stopping_power{500, 2.558}, stopping_power{1e3, 2.054}, stopping_power{3e3, 1.852}, stopping_power{1e4, 1.976}};
inline constexpr std::array proton_in_aluminium{stopping_power{10, 33.76},  stopping_power{50, 9.594},  stopping_power{100, 5.678}, stopping_power{200, 3.526},
                                                stopping_power{500, 2.167}, stopping_power{1e3, 1.750}, stopping_power{3e3, 1.619}, stopping_power{1e4, 1.768}};
// Electrons, NIST ESTAR (same report), collision stopping power.
inline constexpr std::array electron_in_mylar{stopping_power{1, 1.710},   stopping_power{2, 1.686},   stopping_power{10, 1.831},
                                              stopping_power{100, 2.043}, stopping_power{200, 2.100}, stopping_power{1000, 2.229}};

/// Smallest mean loss of a muon, MeV cm2/g: PDG 2024, Atomic and Nuclear Properties, "Minimum ionization".
namespace minimum_ionisation {

inline constexpr double polystyrene = 1.936, mylar = 1.848, helium = 1.937, aluminium = 1.615, liquid_hydrogen = 4.034, lithium_hydride = 1.897, air = 1.815;

}  // namespace minimum_ionisation

}  // namespace reference
