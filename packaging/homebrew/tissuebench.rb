# Formula for a tap. A release fills in the address of the project and the hash of its source archive.
class Tissuebench < Formula
  desc "Verification and benchmarks of soft-tissue solvers"
  version "0.2.0"
  url "#{ENV.fetch("TISSUEBENCH_SOURCE")}"
  sha256 "#{ENV.fetch("TISSUEBENCH_SHA256")}"
  license any_of: ["MIT", "Apache-2.0"]

  depends_on "rust" => :build

  def install
    system "cargo", "install", *std_cargo_args(path: "harness")
    generate_completions_from_executable(bin/"tissuebench", "completions")
  end

  test do
    assert_match version.to_s, shell_output("#{bin}/tissuebench --version")
  end
end
