// The implicit-explicit Runge-Kutta scheme ARS(2,2,2) [Ascher, Ruuth & Spiteri 1997, section 2.6], a = 1 - 1/sqrt 2, e = 1 - 1/(2a):
//   U1 = S_a(U0 + a dt A0),   U2 = S_a(U0 + dt (e A0 + (1 - e) A1) + dt (1 - a) I1),
// A the change by advection, I1 what the first solve added per time, S_a a solve and its update over a dt. Internal energy is carried by
// the mean of both sides of a face, and that part belongs to I, with the pressure and the face velocity of the solve: power and flux
// together are those of the enthalpy. In A it would be an explicit p div u, and noise would blow up from c dt = 3 dx on. With c1 = a dt A0 and
// c2 = (1 - e) dt A1 the start of the second solve is U1 + sqrt 2 (U1 - (U0 + (2 + sqrt 2) c1)) + c2: one state is kept.

const ARS_SHARE = 0.29289322;   // a: part of the step that each solve spans
const ARS_SECOND = 5.8284271;   // (1 - e) / a
const ARS_CHANGE = 3.4142136;   // 2 + sqrt 2
const ARS_KEPT = 1.4142136;     // sqrt 2
