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
        for outputs in [length as usize, length as usize + 1] {
            let output = Buffer::<u32>::new(&gpu, "output", outputs).unwrap();
            let scan = Scan::new(&gpu, &input, &output, length).unwrap();
            let mut pass = Pass::new(&gpu, "scan");
            scan.record(&mut pass);
            pass.submit().unwrap();
            let found = readback::read(&gpu, &output).unwrap();
            let differs = found.iter().zip(&expected).position(|(found, expected)| found != expected);
            assert_eq!(differs, None, "length {length}, output {outputs}: first difference");
        }
    }
}

#[test]
fn a_scan_with_zero_indirect_counts_changes_nothing() {
    let Some(gpu) = gpu_or_skip() else { return };
    let values = vec![1u32; 5000];
    let input = Buffer::from_slice(&gpu, "input", &values).unwrap();
    let output = Buffer::from_slice(&gpu, "output", &vec![9u32; 5000]).unwrap();
    let scan = Scan::new(&gpu, &input, &output, 5000).unwrap();
    let counts = scan.group_counts();
    assert_eq!(counts.len(), 2, "up, down");
    let indirect = Buffer::<u32>::indirect(&gpu, "counts", 3 * counts.len()).unwrap();
    let extents: Vec<_> = (0..counts.len()).map(|level| Extent::Indirect(&indirect, 12 * level as u64)).collect();
    for (written, last) in [(vec![0; 6], 9), (counts.concat(), 4999)] {
        indirect.write(&gpu, 0, &written);
        let mut pass = Pass::new(&gpu, "scan");
        scan.record_with(&mut pass, &extents);
        pass.submit().unwrap();
        assert_eq!(readback::read(&gpu, &output).unwrap()[4999], last);
    }
}
