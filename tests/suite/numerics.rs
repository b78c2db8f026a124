//! Reduction and prefix sum against the CPU, on lengths around every border of their shapes.

use brisance::gpu::{Buffer, Extent, Gpu, Pass, readback};
use brisance::numerics::{Operator, Reduce, Scan};

use crate::common::{Random, gpu_or_skip};

/// Around one thread, one workgroup, one block, two levels, and more than 65535 workgroups of one element per thread.
const LENGTHS: [u32; 11] = [0, 1, 63, 64, 65, 1023, 1024, 1025, 65_536, 1_048_577, 65_536 * 64 + 17];

fn reduced(gpu: &Gpu, operator: Operator, values: &[f32]) -> f32 {
    let buffer = Buffer::from_slice(gpu, "values", values).unwrap();
    let reduce = Reduce::new(gpu, operator, &buffer, values.len() as u32).unwrap();
    let mut pass = Pass::new(gpu, "reduce");
    reduce.record(&mut pass);
    pass.submit().unwrap();
    readback::read(gpu, reduce.result()).unwrap()[0]
}

#[test]
fn reductions_agree_with_the_cpu() {
    let Some(gpu) = gpu_or_skip() else { return };
    for length in LENGTHS {
        let mut random = Random(u64::from(length));
        let values: Vec<f32> = (0..length).map(|_| random.between(-3.0, 5.0)).collect();
        let sum: f64 = values.iter().map(|value| f64::from(*value)).sum();
        let size: f64 = values.iter().map(|value| f64::from(value.abs())).sum();
        // A thread adds at most length / 65536 values, then 16 partial results, then two trees of depth 6.
        let roundings = f64::from(length / 65_536 + 16 + 12);
        let error = (f64::from(reduced(&gpu, Operator::Sum, &values)) - sum).abs();
        assert!(error <= roundings * f64::from(f32::EPSILON) * size, "sum of {length}: error {error}, of {size}");
        let min = values.iter().copied().fold(f32::MAX, f32::min);
        assert_eq!(reduced(&gpu, Operator::Min, &values), min, "minimum of {length}");
        let max = values.iter().copied().fold(f32::MIN, f32::max);
        assert_eq!(reduced(&gpu, Operator::Max, &values), max, "maximum of {length}");
    }
}

#[test]
fn a_sum_has_equal_bits_on_every_run() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut random = Random(7);
    let values: Vec<f32> = (0..(1 << 20)).map(|_| random.between(-1.0, 1.0)).collect();
    let first = reduced(&gpu, Operator::Sum, &values);
    for run in 1..4 {
        assert_eq!(reduced(&gpu, Operator::Sum, &values).to_bits(), first.to_bits(), "run {run}");
    }
}

fn exclusive_sums(values: &[u32]) -> Vec<u32> {
    let mut sum = 0u32;
    let mut sums = vec![0];
    for value in values {
        sum = sum.wrapping_add(*value);
        sums.push(sum);
    }
    sums
}

#[test]
fn scans_agree_with_the_cpu() {
    let Some(gpu) = gpu_or_skip() else { return };
    for length in LENGTHS {
        let mut random = Random(u64::from(length));
        // Sums of the longest arrays pass 2^32: wrapping is part of the contract.
        let values: Vec<u32> = (0..length).map(|_| (random.bits() >> 52) as u32).collect();
        let expected = exclusive_sums(&values);
        let input = Buffer::from_slice(&gpu, "input", &values).unwrap();
        for total in [false, true] {
            let output = Buffer::<u32>::new(&gpu, "output", length as usize + usize::from(total)).unwrap();
            let scan = Scan::new(&gpu, input.raw(), output.raw(), length, total).unwrap();
            let mut pass = Pass::new(&gpu, "scan");
            scan.record(&mut pass);
            pass.submit().unwrap();
            let found = readback::read(&gpu, &output).unwrap();
            let differs = found.iter().zip(&expected).position(|(found, expected)| found != expected);
            assert_eq!(differs, None, "length {length}, total {total}: first difference");
        }
    }
}

#[test]
fn a_gated_scan_runs_only_while_the_gate_is_open() {
    let Some(gpu) = gpu_or_skip() else { return };
    let input = Buffer::from_slice(&gpu, "input", &[1u32; 5000]).unwrap();
    let output = Buffer::from_slice(&gpu, "output", &[9u32; 5001]).unwrap();
    let scan = Scan::new(&gpu, input.raw(), output.raw(), 5000, true).unwrap();
    let gate = Buffer::<u32>::indirect(&gpu, "gate", 4).unwrap();
    for (groups, last) in [(0, 9), (1, 5000), (0, 7)] {
        output.write(&gpu, 5000, &[if last == 7 { 7 } else { 9 }]);
        gate.write(&gpu, 1, &[groups, 1, 1]);
        let mut pass = Pass::new(&gpu, "scan");
        scan.record_gated(&mut pass, &Extent::Indirect(&gate, 4));
        pass.submit().unwrap();
        assert_eq!(readback::read(&gpu, &output).unwrap()[5000], last, "{groups} workgroups");
    }
    assert!(Scan::new(&gpu, input.raw(), output.raw(), 5001, true).is_err(), "longer than the input");
}
