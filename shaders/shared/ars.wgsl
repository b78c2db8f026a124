// Two solves per step, second order in time: the implicit half is that of ARS(2,2,2) [Ascher, Ruuth & Spiteri 1997, section 2.6], with
// a = 1 - 1/sqrt 2; the explicit half has the three stages of Wicker and Skamarock [2002]:
//   U1 = S_a(U0 + a dt A(U0)),   V = U0 + dt/2 (A(U1) + I1),   U2 = S_a(U0 + dt A(V) + (1 - a) dt I1),
// A the change by advection, S_a a solve and its update over a dt, I1 what the first one added per time: (U1 - K) / (a dt), K what it
// started from. (With the two explicit stages of ARS, sound that runs with the stream grows, by up to 1.5 % per step: advection of
// fifth order dampens long waves too little for schemes that are unstable without damping.)
// Internal energy is carried by the new velocity of the face, and that part, H times the velocity, belongs to I, with H the mean of
// both sides at the start of the step: in A it would be an explicit p div u, and noise would blow up from c dt = 3 dx on.

const ARS_SHARE = 0.29289322;   // a: part of the step that each solve spans
const ARS_MIDDLE = 1.7071068;   // dt/2 over a dt
const ARS_LAST = 3.4142136;     // dt over a dt
const ARS_RETURNED = 2.4142136; // (1 - a) dt over a dt
